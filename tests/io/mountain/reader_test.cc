#include "lobefit/io/mountain/reader.h"

#include <cmath>

#include "tests/support/read_bytes.h"

namespace lobefit {
namespace {

TEST(Mountain, DsfIsDividedByTheOutgoingCosine) {
  constexpr char kFile[] =
      "#sample_name \"by hand\"\n#format: theta phi DSF\n#incident_angle 40 180\n#datapoints_in_file: 4\n#unknown 3\n"
      "60 10 0.25\n0 0 0.5\n100 0 1\n30 400 0.125\n";
  ASSERT_TRUE(IsMountain(kFile));
  const Measurement m = ReadBytes(ReadMountain, kFile);
  ASSERT_EQ(m.samples.size(), 3U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kBelowHorizon], 1U);
  ExpectAngles(m.samples.wi(0), 40, 180);
  ExpectAngles(m.samples.wo(0), 60, 10);
  ExpectAngles(m.samples.wo(2), 30, 40);
  EXPECT_NEAR(m.samples.values[0][0], 0.25 / 0.5, 1e-15);
  EXPECT_NEAR(m.samples.values[0][1], 0.5, 1e-15);
  EXPECT_NEAR(m.samples.values[0][2], 0.125 / std::cos(kPi / 6), 1e-15);
  EXPECT_EQ(m.conventions.at("value-kind"), "f-cos-o (header)");
  EXPECT_EQ(m.samples.origin, (std::vector<std::uint32_t>{6, 7, 9}));
}

TEST(Mountain, BrdfHasNoCosineAndMayBeXyz) {
  const Measurement m = ReadBytes(
      ReadMountain, "#format: theta phi BRDF\r\n#intheta 20\r\n#inphi 30\r\n#colorimetry: CIE-XYZ\r\n60 10 1 2 3\r\n");
  EXPECT_EQ(m.channels.names, (std::vector<std::string>{"X", "Y", "Z"}));
  ExpectAngles(m.samples.wi(0), 20, 30);
  EXPECT_EQ(m.samples.values[0][0], 1);
  EXPECT_EQ(m.samples.values[2][0], 3);
}

TEST(Mountain, UpIsTurnedToYOnlyWhenAsked) {
  constexpr char kFile[] = "#format: theta phi BRDF\n#upphi 30\n#incident_angle 20 0\n60 10 1\n";
  ExpectAngles(ReadBytes(ReadMountain, kFile).samples.wi(0), 20, 0);
  ReadOptions options;
  options.mountain_azimuth = MountainAzimuth::kUp;
  const Measurement m = ReadBytes(ReadMountain, kFile, options);
  ExpectAngles(m.samples.wi(0), 20, 60);
  ExpectAngles(m.samples.wo(0), 60, 70);
  EXPECT_EQ(m.conventions.at("mountain-azimuth"), "up (phi 30, header)");
}

TEST(Mountain, LightFromBehindTurnsTheSampleAboutY) {
  const Measurement m = ReadBytes(ReadMountain, "#format: theta phi DSF\n#incident_angle 150 20\n120 10 1\n20 0 1\n");
  ASSERT_EQ(m.samples.size(), 1U);
  // (x, y, z) -> (-x, y, -z): azimuth phi becomes 180 - phi.
  ExpectAngles(m.samples.wi(0), 30, 160);
  ExpectAngles(m.samples.wo(0), 60, 170);
  EXPECT_NEAR(m.samples.values[0][0], 2, 1e-14);
}

TEST(Mountain, FilesThatWereJoinedAreReadAsTheirParts) {
  const Measurement m = ReadBytes(ReadMountain,
                                  "#format: theta phi DSF\n#incident_angle 40 180\n#datapoints_in_file: 1\n60 10 0.25\n"
                                  "#intheta 20\n#inphi 0\n#datapoints_in_file: 2\n#format: theta phi DSF\n60 10 1\n"
                                  "# a comment\n0 0 2\n#intheta 30\n60 10 3\n");
  ASSERT_EQ(m.samples.size(), 4U);
  ExpectAngles(m.samples.wi(0), 40, 180);
  ExpectAngles(m.samples.wi(1), 20, 0);
  ExpectAngles(m.samples.wi(2), 20, 0);
  ExpectAngles(m.samples.wi(3), 30, 0);
  EXPECT_NEAR(m.samples.values[0][3], 6, 1e-14);
}

TEST(Mountain, SaysWhatIsWrongAndWhere) {
  const std::string head = "#format: theta phi DSF\n#incident_angle 40 180\n";
  EXPECT_EQ(ErrorOf(ReadMountain, "#format: theta phi BRF\n"),
            "line 1: the format names the value 'BRF'; allowed are DSF, BSDF, BRDF, BTDF");
  EXPECT_EQ(
      ErrorOf(ReadMountain, "#incident_angle 40 180\n1 2 3\n"),
      "line 2: the rows begin, but the header has no '#format: theta phi DSF' (or BRDF), so that the cosine is not "
      "known; add it");
  EXPECT_EQ(
      ErrorOf(ReadMountain, "#format: theta phi DSF\n#intheta 3\n1 2 3\n"),
      "line 3: the rows begin, but the header has no incident direction; add '#incident_angle THETA PHI' in degrees, "
      "towards the source");
  EXPECT_EQ(ErrorOf(ReadMountain, head + "1 2\n"), "line 3: has 2 fields; the header announces theta phi and 1 value");
  EXPECT_EQ(ErrorOf(ReadMountain, head + "1 2 3\n#intheta 3\n"),
            "line 4: the file ends after the header of a part; it has no rows and may be cut off");
  EXPECT_EQ(ErrorOf(ReadMountain, head + "1 2 3\n#format: theta phi BRDF\n#intheta 3\n#inphi 4\n5 6 7\n"),
            "line 7: the rows begin to hold other values than those above (#format, #colorimetry); put the parts into "
            "files of their own");
  EXPECT_EQ(ErrorOf(ReadMountain, head + "#datapoints_in_file: 2\n1 2 3"),
            "line 4: the file ends after 1 rows, but line 3 announces 2 (#datapoints_in_file); it may be cut off");
  EXPECT_EQ(ErrorOf(ReadMountain, head + "120 2 3"),
            "line 3: the file holds transmission (number of rows 1, all on the side away from the light or the format "
            "is BTDF); "
            "only reflection can be fitted");
  EXPECT_EQ(ErrorOf(ReadMountain, head), "line 2: the file ends after its header; it has no rows and may be cut off");
}

}  // namespace
}  // namespace lobefit
