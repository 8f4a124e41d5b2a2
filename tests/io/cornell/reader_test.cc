#include "lobefit/io/cornell/reader.h"

#include "tests/support/read_bytes.h"

namespace lobefit {
namespace {

constexpr char kTwoSamples[] =
    "# Somewhere\n\n# num wls\n3\n\n400 500\r\n600.5\n# theta i, phi i, theta s, phi_s, values\n"
    "0.5 0 0.25 3 0.1 0.2 0.3\n1.0 0.5 1.25\n-1 0.4 0.5 0.6";

TEST(Cornell, SamplesMayRunOverLines) {
  ASSERT_TRUE(IsCornell(kTwoSamples));
  const Measurement m = ReadBytes(ReadCornell, kTwoSamples);
  ASSERT_EQ(m.samples.size(), 2U);
  EXPECT_EQ(m.channels.names, (std::vector<std::string>{"400nm", "500nm", "600.5nm"}));
  EXPECT_EQ(m.channels.wavelengths_nm, (std::vector<double>{400, 500, 600.5}));
  const double degrees = 180 / kPi;
  ExpectAngles(m.samples.wi(0), 0.5 * degrees, 0);
  ExpectAngles(m.samples.wo(0), 0.25 * degrees, 3 * degrees);
  ExpectAngles(m.samples.wi(1), degrees, 0.5 * degrees);
  ExpectAngles(m.samples.wo(1), 1.25 * degrees, -degrees);
  EXPECT_EQ(m.samples.values[2], (std::vector<double>{0.3, 0.6}));
  EXPECT_EQ(m.samples.origin, (std::vector<std::uint32_t>{9, 10}));
}

TEST(Cornell, OtherTextIsNotTakenForIt) {
  EXPECT_FALSE(IsCornell("1,2,3\n"));
  EXPECT_FALSE(IsCornell("3 400 500 600\n"));
  EXPECT_FALSE(IsCornell("2\n600 500\n"));
  EXPECT_FALSE(IsCornell("2\n0.5 0.6\n"));
  EXPECT_FALSE(IsCornell(""));
}

TEST(Cornell, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(ErrorOf(ReadCornell, std::string(kTwoSamples) + "\n0.5 0 0.2"),
            "line 12: the file ends where phi_o should stand; it may be cut off: fetch or export it again");
  EXPECT_EQ(ErrorOf(ReadCornell, std::string(kTwoSamples) + " 7\n0.5 0 0.2"),
            "line 11: theta_i is 7, beyond pi; angles are in radians, each sample has 4 angles and 3 values");
  EXPECT_EQ(ErrorOf(ReadCornell, "2\n400 400\n"),
            "line 2: the wavelength 400 does not rise above the one before it, 400");
  EXPECT_EQ(
      ErrorOf(ReadCornell, "4000000000\n400 400\n"),
      "line 1: the number of wavelengths: 4000000000 values should follow, but the file has only 4 more at most; the "
      "counts of the header are wrong or the file is cut off");
}

}  // namespace
}  // namespace lobefit
