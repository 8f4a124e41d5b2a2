#include "lobefit/io/zemax/reader.h"

#include "tests/support/read_bytes.h"

namespace lobefit {
namespace {

std::string File(const std::string& symmetry, const std::string& rotations, const std::string& sections,
                 const std::string& content = "Monochrome") {
  return "# made by hand\r\nSource\tMeasured\r\nSymmetry\t" + symmetry + "\r\nSpectralContent\t" + content +
         "\r\nScatterType\tBRDF\r\nSampleRotation\t" + rotations +
         "\r\nAngleOfIncidence\t1\r\n30\r\nScatterAzimuth\t2\r\n0\t90\r\nScatterRadial\t3\r\n0\t20\t80\r\n\r\n" +
         sections;
}
constexpr char kOneGrid[] = "TIS 0.1\n1 2 3\n4 5 0\n";

TEST(Zemax, AnglesLieAroundTheSpecularDirection) {
  const std::string bytes =
      File("PlaneSymmetrical", "1\n0", std::string("Monochrome\nDataBegin\n") + kOneGrid + "DataEnd\n");
  ASSERT_TRUE(IsZemax(bytes));
  const Measurement m = ReadBytes(ReadZemax, bytes);
  // Radial 0 is the specular direction at both azimuths. Radial 80 at azimuth 0 goes over the normal to 50 degrees on
  // the light's side; at azimuth 90, z = cos(80) cos(30) > 0 and the value 0 is a hole.
  ASSERT_EQ(m.samples.size(), 4U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kDuplicate], 1U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 1U);
  EXPECT_EQ(m.set_aside.total(), 2U);
  for (std::size_t i = 0; i < 4; ++i) ExpectAngles(m.samples.wi(i), 30, 0);
  ExpectAngles(m.samples.wo(0), 30, 180);
  ExpectAngles(m.samples.wo(1), 10, 180);
  ExpectAngles(m.samples.wo(2), 50, 0);
  // cos(20) (-1/2, 0, sqrt(3)/2) + sin(20) (0, 1, 0)
  ExpectVector(m.samples.wo(3), {-0.46984631039295416, 0.34202014332566871, 0.81379768134937369});
  EXPECT_EQ(m.samples.values[0], (std::vector<double>{1, 2, 3, 5}));
  EXPECT_EQ(m.samples.origin, (std::vector<std::uint32_t>{18, 18, 18, 19}));
  EXPECT_TRUE(m.isotropic);
  EXPECT_EQ(m.channels.names, std::vector<std::string>{"Y"});
}

TEST(Zemax, RotationTurnsTheWholeConfigurationWithTheChosenSign) {
  const std::string bytes = File("ASymmetrical4D", "2\n0 90",
                                 std::string("Monochrome\nDataBegin\n") + kOneGrid + "TIS 1\n6 7 8 9 10 11\nDataEnd\n");
  for (const int sign : {1, -1}) {
    ReadOptions options;
    options.zemax_rotation_sign = sign;
    const Measurement m = ReadBytes(ReadZemax, bytes, options);
    ASSERT_EQ(m.samples.size(), 4U + 5U);
    EXPECT_FALSE(m.isotropic);
    ExpectAngles(m.samples.wi(4), 30, sign * 90);
    ExpectAngles(m.samples.wo(5), 10, sign * 90 + 180);
    EXPECT_EQ(m.samples.values[0][5], 7);
    EXPECT_EQ(m.conventions.at("zemax-rotation-sign"), sign > 0 ? "+1" : "-1");
  }
}

TEST(Zemax, TristimulusSectionsBecomeChannelsInAnyOrder) {
  const auto section = [](const std::string& name, const std::string& values) {
    return "Tristimulus" + name + "\nDataBegin\nTIS 0\n" + values + "\nDataEnd\n";
  };
  const Measurement m = ReadBytes(
      ReadZemax, File("Asymmetrical", "1\n0",
                      section("Z", "1 0 3 4 5 6") + section("X", "7 0 9 1 2 3") + section("Y", "4 5 6 7 8 9"), "XYZ"));
  EXPECT_EQ(m.channels.names, (std::vector<std::string>{"X", "Y", "Z"}));
  ASSERT_EQ(m.samples.size(), 5U);
  EXPECT_EQ(m.samples.values[0][1], 0);  // not a hole: Y is not 0
  EXPECT_EQ(m.samples.values[1][1], 5);
  EXPECT_EQ(m.samples.values[2][2], 3);
}

TEST(Zemax, BelowTheHorizonComesBeforeHole) {
  std::string bytes =
      File("PlaneSymmetrical", "1\n0", std::string("Monochrome\nDataBegin\nTIS 0\n1 2 0 1 2 3\nDataEnd\n"));
  bytes.replace(bytes.find("0\t90"), 4, "180\t90");  // away from the normal
  const Measurement m = ReadBytes(ReadZemax, bytes);
  EXPECT_EQ(m.set_aside[SetAsideReason::kBelowHorizon], 1U);  // 30 + 80 degrees from the normal
  EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 0U);
}

TEST(Zemax, SaysWhatIsWrongAndWhere) {
  const std::string grid = std::string("Monochrome\nDataBegin\n") + kOneGrid + "DataEnd\n";
  EXPECT_EQ(ErrorOf(ReadZemax, File("Round", "1\n0", grid)),
            "line 3: Symmetry is 'Round'; allowed are PlaneSymmetrical, ASymmetrical, ASymmetrical4D");
  EXPECT_EQ(ErrorOf(ReadZemax, File("ASymmetrical", "1\nx", grid)),
            "line 7: one of the sample rotations is 'x', which is not a number; write it as in 0.25 or 2.5e-1");
  EXPECT_EQ(
      ErrorOf(ReadZemax, File("ASymmetrical", "2\n0 90", grid)),
      "line 20: found 'DataEnd' where TIS should begin grid 2 of 2, one a sample rotation and angle of incidence, "
      "each 2 x 3 values");
  EXPECT_EQ(ErrorOf(ReadZemax, File("ASymmetrical", "1\n0", grid + "1")),
            "line 21: '1' stands after the last section; nothing is allowed there");
  // 2^62 grids: refused before anything is allocated.
  EXPECT_EQ(
      ErrorOf(ReadZemax, File("ASymmetrical", "4611686018427387904\n0", grid)),
      "line 6: the number of sample rotations: 4611686018427387904 values should follow, but the file has only 64 "
      "more at most; the counts of the header are wrong or the file is cut off");
}

}  // namespace
}  // namespace lobefit
