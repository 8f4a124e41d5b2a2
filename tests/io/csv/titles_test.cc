// What titles and comments say of the values, where the names of their columns do not.
#include <cmath>
#include <string>

#include "tests/io/csv/read_csv.h"

namespace lobefit {
namespace {

// Light at 60 degrees, viewer at 40, the number 0.5 under a name that says nothing of its kind.
std::string Below(const std::string& title) { return title + "\ntheta_i,phi_i,theta_o,phi_o,550nm\n60,0,40,180,0.5\n"; }
double ValueBelow(const std::string& title) { return ReadText(Below(title)).samples.values[0][0]; }

TEST(CsvTitles, ReflectanceFactors) {
  for (const char* title :
       {"BRF Values", "# BRF of sample 7", "# Bidirectional reflectance factor", "HDRF measurements of a field",
        "# Quantity: BRF", "# Data type: reflectance factor", "Data type,Reflectance Factor,,,", "BRF values,,,,",
        "Strahldichtefaktor der Probe 7", "Facteur de r\u00e9flectance", "# Factor de reflectancia bidireccional",
        "# \u53cd\u5c04\u7387\u56e0\u5b50", "# radiance coefficient"}) {
    const Measurement m = ReadText(Below(title));
    EXPECT_NEAR(m.samples.values[0][0], 0.5 / kPi, 1e-12) << title;
    EXPECT_EQ(m.conventions.at("value-kind"), "pi-f (title)") << title;
    EXPECT_TRUE(HasRemark(m, "the values are taken as pi-f")) << title;
  }
}

TEST(CsvTitles, KindsWithCosines) {
  const double cos_i = std::cos(DegreesToRadians(60)), cos_o = std::cos(DegreesToRadians(40));
  EXPECT_NEAR(ValueBelow("ARS measurement of sample 3"), 0.5 / cos_o, 1e-12);
  EXPECT_NEAR(ValueBelow("# ARS (1/sr)"), 0.5 / cos_o, 1e-12);
  EXPECT_NEAR(ValueBelow("# Cosine corrected BSDF"), 0.5 / cos_o, 1e-12);
  EXPECT_NEAR(ValueBelow("I/F of an analogue"), 0.5 / (kPi * cos_i), 1e-12);
  EXPECT_NEAR(ValueBelow("# radiance factor (I/F)"), 0.5 / (kPi * cos_i), 1e-12);
  EXPECT_TRUE(HasRemark(ReadText(Below("# Y-axis: BRDF*cos(theta)")), "of which angle (--value-kind f-cos-o"));
}

TEST(CsvTitles, UnitsBesideTheKind) {
  EXPECT_NEAR(ValueBelow("# BRF [%]"), 0.005 / kPi, 1e-12);
  EXPECT_NEAR(ValueBelow("# reflectance factor in %"), 0.005 / kPi, 1e-12);
  EXPECT_NEAR(ValueBelow("# BRDF in 10^-3 1/sr"), 0.5e-3, 1e-12);
  EXPECT_NEAR(ValueBelow("# log10 BRDF"), std::sqrt(10), 1e-12);
}

// The nearer word goes first: an option, a key, the name of the column.
TEST(CsvTitles, GiveWay) {
  ReadOptions options;
  options.value_kind = ValueKind::kBrdf;
  EXPECT_EQ(ReadText(Below("BRF Values"), options).samples.values[0][0], 0.5);
  EXPECT_EQ(ValueBelow("BRF Values\n# value-kind: f"), 0.5);
  EXPECT_EQ(ReadText("BRF Values\ntheta_i,theta_o,brdf\n60,40,0.5\n").samples.values[0][0], 0.5);
  // A name that leaves it open takes it.
  EXPECT_NEAR(ReadText("BRF Values\ntheta_i,theta_o,Reflectance\n60,40,0.5\n").samples.values[0][0], 0.5 / kPi, 1e-12);
}

// Other things that such words stand in.
TEST(CsvTitles, ChangeNothing) {
  for (const char* title : {"BRDF of a tile", "# Calibrated against the BRF of a NIST standard", "# BRF file: tile.txt",
                            "# BRDF, computed from BRF", "# truth, factor: 2", "# Lens factor 2", "USDA ARS soil 3",
                            "# The BRF model was not used", "# Reflectance standard SRS-99"})
    EXPECT_EQ(ValueBelow(title), 0.5) << title;
  EXPECT_TRUE(HasRemark(ReadText(Below("# BRDF and BRF of the sample")), "more than one kind of value"));
}

TEST(CsvTitles, MultiplesThatNoLineStatesForSure) {
  for (const char* title : {"# values are multiplied by 1000", "# all data x 1000", "# data in percent",
                            "# Werte in dB", "# all values have been multiplied by 100", "# scaling: 0.01"}) {
    const Measurement m = ReadText(Below(title));
    EXPECT_EQ(m.samples.values[0][0], 0.5) << title;
    EXPECT_TRUE(HasRemark(m, "say with --value-scale")) << title;
  }
  for (const char* title : {"# humidity 45 percent", "# 10 times averaged", "# values in dB", "# BRDF data of 2024"})
    EXPECT_FALSE(HasRemark(ReadText(Below(title)), "say with --value-scale")) << title;
  ReadOptions options;
  options.value_scale = "1/sr";
  EXPECT_FALSE(HasRemark(ReadText(Below("# data in percent"), options), "say with --value-scale"));
}

TEST(CsvTitles, QuestionsWhereTheyLeaveItOpen) {
  for (const char* title :
       {"# relative to Spectralon", "# Normalized to white standard (Spectralon 99%)", "# Reflectance of soil"})
    EXPECT_TRUE(HasRemark(ReadText(Below(title)), "(--value-kind pi-f)?")) << title;
  for (const char* title : {"# normalized to peak", "# BRDF normalised to 1 at specular", "# Radiance in W/m2/sr",
                            "# uncalibrated intensities, arbitrary units"}) {
    EXPECT_TRUE(HasRemark(ReadText(Below(title)), "fit with --scale free")) << title;
  }
  EXPECT_FALSE(HasRemark(ReadText(Below("# angles relative to the specular direction")), "--scale free"));
  EXPECT_TRUE(HasRemark(ReadText(Below("# Transmission scatter")), "reflected light"));
  EXPECT_FALSE(HasRemark(ReadText(Below("# BRDF and BTDF of a diffuser")), "reflected light"));
  EXPECT_TRUE(HasRemark(ReadText(Below("# s-polarized light")), "not of unpolarised light"));
  EXPECT_FALSE(HasRemark(ReadText(Below("# mean of s-polarized and p-polarized light")), "unpolarised"));
}

}  // namespace
}  // namespace lobefit
