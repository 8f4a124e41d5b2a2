// Sentences about where angles count from, and angles that are related to another direction than the normal.
#include <cmath>

#include "tests/io/csv/read_csv.h"

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// Light at 30 degrees, viewer at 40 degrees and azimuth 20 of the file.
const std::string kRow = "theta_i,theta_r,relative azimuth,brdf\n30,40,20,1\n";

// Cosine of the azimuth between the two directions.
double CosBetween(const Measurement& m) {
  const Vec3 wi = m.samples.wi(0), wo = m.samples.wo(0);
  return (wi.x * wo.x + wi.y * wo.y) / (std::hypot(wi.x, wi.y) * std::hypot(wo.x, wo.y));
}

TEST(CsvConventions, AzimuthZeroAtTheMirror) {
  for (const char* line :
       {"# azimuth 0 is the specular direction", "# The azimuth is counted from the forward direction.",
        "# Azimut 0° liegt in Vorwärtsrichtung (Spiegelrichtung)", "# azimut 0 = direction spéculaire",
        "# phi = 180 is backscatter, phi = 0 forward", "# relative azimuth: 180 deg towards the light source"}) {
    const Measurement m = ReadText(std::string(line) + "\n" + kRow);
    EXPECT_NEAR(CosBetween(m), -std::cos(DegreesToRadians(20)), 1e-12) << line;
    EXPECT_TRUE(HasRemark(m, "line 1: azimuths count from the mirror's side")) << line;
  }
}

TEST(CsvConventions, AzimuthZeroAtTheLight) {
  for (const char* line : {"# phi = 0 is the backscatter (retro) direction, phi = 180 the specular one",
                           "# azimuths clockwise from the plane of incidence; forward scattering at 180",
                           "# Azimut 180° ist die Glanzrichtung", "# azimuth of the sample's grain: 0 deg",
                           // What contradicts itself changes nothing.
                           "# azimuth 0 is forward, azimuth 0 is backward"}) {
    const Measurement m = ReadText(std::string(line) + "\n" + kRow);
    EXPECT_NEAR(CosBetween(m), std::cos(DegreesToRadians(20)), 1e-12) << line;
  }
}

TEST(CsvConventions, OptionsGoBeforeSentences) {
  ReadOptions options;
  options.incident_sense = IncidentSense::kTowardsSource;
  const Measurement m = ReadText("# azimuth 0 is the specular direction\n" + kRow, options);
  EXPECT_NEAR(CosBetween(m), std::cos(DegreesToRadians(20)), 1e-12);
}

// The viewer's angle from the normal, on the mirror's side, in degrees.
double ViewerDeg(const Measurement& m) { return RadiansToDegrees(std::atan2(-m.samples.wo_x[0], m.samples.wo_z[0])); }

TEST(CsvConventions, ViewerAnglesFromTheMirrorDirection) {
  const std::string row = "AOI,scatter angle,brdf\n30,12,1\n";
  EXPECT_NEAR(ViewerDeg(ReadText(row)), 12, 1e-9);
  for (const char* line :
       {"# scatter angles are relative to the specular direction", "# detector angle measured from the specular beam",
        "# Streuwinkel bezogen auf den Glanzwinkel"}) {
    EXPECT_NEAR(ViewerDeg(ReadText(std::string(line) + "\n" + row)), 42, 1e-9) << line;
  }
  EXPECT_NEAR(ViewerDeg(ReadText("# scatter angles are measured from the surface normal\n" + row)), 12, 1e-9);
  EXPECT_NE(MessageOf("# scatter angle is measured from the incident beam\n" + row).find("--columns \"bistatic="),
            std::string::npos);
}

TEST(CsvConventions, BistaticAndDeviationAngles) {
  EXPECT_NEAR(ViewerDeg(ReadText("AOI,bistatic angle,brdf\n30,72,1\n")), 42, 1e-9);
  EXPECT_NEAR(ViewerDeg(ReadText("AOI,bistatic angle,brdf\n30,10,1\n")), -20, 1e-9);
  EXPECT_NEAR(ViewerDeg(ReadText("AOI,deviation angle,brdf\n30,108,1\n")), 42, 1e-9);
  // Beside the angle that it follows from it is not needed.
  EXPECT_NEAR(ViewerDeg(ReadText("AOI,theta_r,deviation angle,brdf\n30,42,108,1\n")), 42, 1e-9);
  EXPECT_NE(MessageOf("theta_i,theta,psi,brdf\n30,42,10,1\n").find("'psi'"), std::string::npos);
}

TEST(CsvConventions, UncertaintiesBehindTheirValues) {
  const Measurement m = ReadText("theta_r,AOI=10,u,AOI=30,u\n20,2,0.1,3,0.3\n40,4,0.4,5,0.5\n");
  ASSERT_EQ(m.samples.size(), 4U);
  ASSERT_EQ(m.samples.sigma.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const double value = m.samples.values[0][i];
    EXPECT_NEAR(m.samples.sigma[i], value == 2 ? 0.1 : value == 3 ? 0.3 : value == 4 ? 0.4 : 0.5, 1e-12);
  }
  EXPECT_EQ(ReadText("theta_r,AOI=10,AOI=10 err,AOI=30,AOI=30 err\n20,2,0.1,3,0.3\n").samples.sigma.size(), 2U);
  EXPECT_NE(MessageOf("theta_r,AOI=10,u,AOI=30\n20,2,0.1,3\n").find("only 1 of 2 columns"), std::string::npos);
  EXPECT_NE(MessageOf("theta_r,AOI=10,err AOI=30,AOI=30,err AOI=10\n20,2,0.1,3,0.3\n").find("of another angle"),
            std::string::npos);
}

TEST(CsvConventions, RelatedToAWhiteStandard) {
  for (const char* name : {"Reflectance factor (rel. to Spectralon)", "reflectance relative to white standard",
                           "radiance factor β", "BRF vs PTFE"}) {
    const Measurement m = ReadText(std::string("theta_i,theta_r,") + name + "\n30,40,0.5\n");
    EXPECT_NEAR(m.samples.values[0][0], 0.5 / kPi, 1e-12) << name;
  }
  EXPECT_NEAR(ReadText("theta_i,theta_r,ARS (1/sr)\n30,60,0.25\n").samples.values[0][0], 0.5, 1e-12);
}

// 45as15 is 15 degrees from the mirror direction towards the light (ASTM E2194).
TEST(CsvConventions, AspecularAngles) {
  const Measurement m = ReadText("AOI,aspecular angle,brdf\n45,15,1\n45,110,1\n");
  EXPECT_NEAR(ViewerDeg(m), 30, 1e-9);
  EXPECT_TRUE(HasRemark(m, "towards the light"));
  EXPECT_NEAR(ViewerDeg(ReadText("Illumination: 45 deg\naspecular,brdf\n-15,1\n")), 60, 1e-9);
  // Numbers that the convention would put behind the sample.
  const Measurement away = ReadText("AOI,aspecular angle,brdf\n60,10,1\n60,-140,1\n");
  EXPECT_NEAR(ViewerDeg(away), 70, 1e-9);
  EXPECT_TRUE(HasRemark(away, "away from the light"));
  ReadOptions options;
  options.columns = "theta_o - theta_i=aspecular";
  EXPECT_NEAR(ViewerDeg(ReadText("AOI,aspecular,brdf\n45,15,1\n", options)), 60, 1e-9);
}

TEST(CsvConventions, AnglesFromTheSurface) {
  const std::string row = "theta_i,theta_o,brdf\n60,50,1\n";
  const auto light = [](const Measurement& m) { return RadiansToDegrees(std::acos(m.samples.wi_z[0])); };
  for (const char* line :
       {"# angles measured from the surface", "# all angles are grazing angles (0 = parallel to the surface)",
        "# Winkel zur Oberfl\u00e4che gemessen", "# elevation angles"}) {
    const Measurement m = ReadText(std::string(line) + "\n" + row);
    EXPECT_NEAR(light(m), 30, 1e-9) << line;
    EXPECT_NEAR(ViewerDeg(m), 40, 1e-9) << line;
    EXPECT_TRUE(HasRemark(m, "polar angles count from the surface")) << line;
  }
  const Measurement one = ReadText("# incidence angle is measured from the surface\n" + row);
  EXPECT_NEAR(light(one), 30, 1e-9);
  EXPECT_NEAR(ViewerDeg(one), 50, 1e-9);
  for (const char* line : {"# angles measured from the surface normal", "# scattering from the surface of a tile",
                           "# measured at a grazing angle", "# angles are not measured from the surface",
                           "# light scattered from the surface at each angle", "# grazing angles are left out",
                           "# angle step 5, distance from the surface 50 cm", "# up to grazing angles",
                           "# Scattered light from the surface for an angle of incidence of 60 degrees"})
    EXPECT_NEAR(light(ReadText(std::string(line) + "\n" + row)), 60, 1e-9) << line;
  ReadOptions options;
  options.columns = "theta_i=theta_i,theta_o=theta_o";
  EXPECT_NEAR(light(ReadText("# angles measured from the surface\n" + row, options)), 60, 1e-9);
}

TEST(CsvConventions, ZenithsAndAzimuthsOfOneLetter) {
  const Measurement m = ReadText("src_z\tsrc_a\tview_z\tview_a\tbrdf\n30\t10\t40\t190\t1\n");
  ExpectSample(m, 0, 30, 10, 40, 190, 1);
  // Beside x and y they are components.
  ExpectSample(ReadText("light_x,light_y,light_z,view_x,view_y,view_z,brdf\n0,0,1,1,0,1,1\n"), 0, 0, 0, 45, 0, 1);
}

TEST(CsvConventions, PlanetaryLetters) {
  for (const char* names : {"i,e,g,I/F", "i e alpha RADF", "i;e;psi;IoF"}) {
    std::string text = std::string(names) + "\n60,60,120,0.5\n";
    if (std::string(names).find(';') != std::string::npos) text = "i;e;psi;IoF\n60;60;180;0.5\n";
    if (std::string(names).find(' ') != std::string::npos) text = "i e alpha RADF\n60 60 120 0.5\n";
    const Measurement m = ReadText(text);
    EXPECT_NEAR(ViewerDeg(m), 60, 1e-5) << names;
    EXPECT_NEAR(m.samples.values[0][0], 1 / kPi, 1e-12) << names;
  }
  EXPECT_NEAR(ReadText("inc,emi,pha,REFF\n60,60,120,0.5\n").samples.values[0][0], 0.5 / kPi, 1e-12);
}

TEST(CsvConventions, VectorsAlongThePropagation) {
  const Measurement m = ReadText("k_in_x,k_in_y,k_in_z,k_out_x,k_out_y,k_out_z,brdf\n0.6,0,-0.8,0,0,1,1\n");
  EXPECT_NEAR(m.samples.wi_x[0], -0.6, 1e-12);
  EXPECT_NEAR(m.samples.wi_z[0], 0.8, 1e-12);
  EXPECT_TRUE(HasRemark(m, "point into the surface"));
  EXPECT_EQ(ReadText("incident.x,incident.y,incident.z,outgoing.x,outgoing.y,outgoing.z,brdf\n0,0,1,0,0,1,1\n")
                .samples.size(),
            1U);
}

TEST(CsvConventions, CosinesOfShortNames) {
  const Measurement m = ReadText("cos_sza,cos_vza,raa,brdf\n0.5,1,0,1\n");
  EXPECT_NEAR(m.samples.wi_z[0], 0.5, 1e-12);
}

TEST(CsvConventions, RepetitionsThatAreUnlike) {
  const std::string head = "theta_i,theta_o,brdf\n30,40,1\n";
  EXPECT_TRUE(HasRemark(ReadText(head + "30,40,9\n"), "1 of 1 repetitions differ from the first"));
  EXPECT_TRUE(HasRemark(ReadText(head + "30,40,1.1\n"), "--repeated mean averages their rows"));
}

}  // namespace
}  // namespace lobefit
