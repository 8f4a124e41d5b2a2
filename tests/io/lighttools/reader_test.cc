#include "lobefit/io/lighttools/reader.h"

#include "tests/support/read_bytes.h"

#include "lobefit/io/zemax/reader.h"

namespace lobefit {
namespace {

std::string File(const std::string& blocks, const std::string& content = "Monochrome") {
  return "Source Measured\nSymmetry PlaneSymmetrical\nSpectralContent " + content +
         "\nScatterAzimuth 2\n0 90\nScatterRadial 3\n0 40 95\nDataBegin\n" + blocks + "DataEnd\n";
}

TEST(LightTools, AnglesAreAbsoluteAndTheLightStandsAtNinetyDegrees) {
  const std::string bytes = File(
      "AOI 20 POI 0 Side Front Wavelength 550 ScatterType BRDF\nTIS 0.5\n1 2 3\n4 0 6\n"
      "AOI 30 POI 0 Side Front Wavelength 550 ScatterType BTDF\nTIS 0.5\n1 2 3\n4 5 6\n"
      "AOI 10 POI 0 Side Back Wavelength 550 ScatterType BRDF\nTIS 0.5\n11 12 13\n14 15 16\n");
  ASSERT_TRUE(IsLightTools(bytes));
  EXPECT_FALSE(IsZemax(bytes));
  const Measurement front = ReadBytes(ReadLightTools, bytes);
  ASSERT_EQ(front.samples.size(), 2U);  // radial 0 twice, 95 below the horizon twice, one hole
  EXPECT_EQ(front.set_aside[SetAsideReason::kDuplicate], 1U);
  EXPECT_EQ(front.set_aside[SetAsideReason::kBelowHorizon], 2U);
  EXPECT_EQ(front.set_aside[SetAsideReason::kHole], 1U);
  ExpectAngles(front.samples.wi(1), 20, 90);
  ExpectAngles(front.samples.wo(1), 40, 0);
  EXPECT_EQ(front.samples.values[0], (std::vector<double>{1, 2}));
  EXPECT_EQ(front.channels.names, std::vector<std::string>{"550nm"});
  EXPECT_EQ(front.channels.wavelengths_nm, std::vector<double>{550});
  EXPECT_TRUE(front.isotropic);
  EXPECT_EQ(front.conventions.at("side"), "front (default)");
  EXPECT_EQ(front.remarks.size(), 3U);

  ReadOptions options;
  options.side = Side::kBack;
  options.lighttools_azimuth_deg = -90;
  const Measurement back = ReadBytes(ReadLightTools, bytes, options);
  ExpectAngles(back.samples.wi(0), 10, -90);
  EXPECT_EQ(back.samples.values[0], (std::vector<double>{11, 12, 15}));
}

// The plane of incidence is counted as the azimuths of the grid are, from where it stands at 0.
TEST(LightTools, ThePlaneOfIncidenceTurnsCounterClockwise) {
  const Measurement m = ReadBytes(
      ReadLightTools, File("AOI 20 POI 30 Side Front Wavelength 550 ScatterType BRDF\nTIS 0.5\n1 2 3\n4 5 6\n"));
  ExpectAngles(m.samples.wi(0), 20, 120);
}

TEST(LightTools, AFileOfTheBackIsReadAsTheBack) {
  const Measurement m = ReadBytes(
      ReadLightTools, File("AOI 10 POI 0 Side Back Wavelength 550 ScatterType BRDF\nTIS 0.5\n1 2 3\n4 5 6\n"));
  EXPECT_EQ(m.samples.values[0], (std::vector<double>{1, 2, 5}));
  EXPECT_EQ(m.conventions.at("side"), "back (default)");
}

TEST(LightTools, TristimulusAndWavelengthBlocksBecomeChannels) {
  const auto block = [](const std::string& keys, const std::string& values) {
    return "AOI 20 Side Front ScatterType BRDF " + keys + " TIS 0 " + values + "\n";
  };
  const Measurement xyz = ReadBytes(ReadLightTools, File(block("TristimulusValue TrisZ", "1 2 3 4 5 6") +
                                                             block("TristimulusValue TrisX", "3 4 5 6 7 8") +
                                                             block("TristimulusValue TrisY", "7 8 9 1 2 3"),
                                                         "XYZ"));
  EXPECT_EQ(xyz.channels.names, (std::vector<std::string>{"X", "Y", "Z"}));
  EXPECT_EQ(xyz.samples.values[0][1], 4);
  EXPECT_EQ(xyz.samples.values[1][1], 8);
  EXPECT_EQ(xyz.samples.values[2][1], 2);

  const std::string red = block("Wavelength 650", "1 2 3 4 5 6"), blue = block("Wavelength 450", "3 4 5 6 7 8");
  const Measurement two = ReadBytes(ReadLightTools, File(red + blue));
  EXPECT_EQ(two.channels.wavelengths_nm, (std::vector<double>{450, 650}));
  EXPECT_EQ(two.samples.values[0][1], 4);
  EXPECT_EQ(two.samples.values[1][1], 2);
  EXPECT_EQ(ErrorOf(ReadLightTools, File(red + red)),
            "line 10: a block of the same incidence, side and channel begins in line 9 already");
  EXPECT_EQ(ErrorOf(ReadLightTools, File(red + "AOI 30 Wavelength 450 TIS 0 1 2 3 4 5 6\n")),
            "line 9: the incidence AOI 20, POI 0 has no block for channel 450nm; each incidence needs all channels");
}

TEST(LightTools, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(ErrorOf(ReadLightTools, File("AOI 100 TIS 0 1 2 3 4 5 6\n")), "line 9: AOI is 100; allowed are 0 to 90");
  EXPECT_EQ(ErrorOf(ReadLightTools, File("AOI 10 TIS 0 1 2 3 4 5\n")),
            "line 10: a value of the block is 'DataEnd', which is not a number; write it as in 0.25 or 2.5e-1");
  EXPECT_EQ(
      ErrorOf(ReadLightTools, File("AOI 10 Sied Front TIS 0 1 2 3 4 5 6\n")),
      "line 9: 'Sied' is not a key of a data block (did you mean 'Side'?); allowed are AOI, POI, Side, Wavelength, "
      "ScatterType, TristimulusValue, TIS, and DataEnd between blocks");
  EXPECT_EQ(
      ErrorOf(ReadLightTools, File("AOI 10 ScatterType BTDF TIS 0 1 2 3 4 5 6\n")),
      "line 10: the file has no block of reflection (ScatterType BRDF) of the front or back; only reflection can be "
      "fitted");
}

}  // namespace
}  // namespace lobefit
