// Keys of the head in any spelling and place, and units of names.
#include <cmath>

#include "tests/io/csv/read_csv.h"
#include <gmock/gmock.h>

#include "lobefit/io/text/units.h"

namespace lobefit {
namespace {

const std::string kRows = "theta_i,phi_i,theta_o,phi_o,brdf\n0.5,0,0.7,3,1\n";

TEST(CsvKeys, AnySpellingAndPlace) {
  for (const char* key : {"# angle-unit: rad",
                          "# angle_unit: rad",
                          "# Angle Unit = radians",
                          "% ANGLE-UNITS: rad",
                          "// angle unit: rad",
                          "# units: rad",
                          "# Angles: radians",
                          "angle unit,rad",
                          "# AngleUnit: rad",
                          "# angle_unit = \"rad\"",
                          "# angle-unit: 'radians'",
                          "# \"angle-unit\": \"rad\"",
                          "# unit_angles=radian",
                          "# unit for all of the angles: rad",
                          "# Einheit Winkel: rad",
                          "# unité des angles : radians",
                          "# units: rad, rad, rad, rad, 1/sr",
                          "# radians",
                          "# angle-unit: rad,,,,",
                          "# angle unit,rad,,,"}) {
    const Measurement m = ReadText(std::string(key) + "\n" + kRows);
    EXPECT_NEAR(std::acos(m.samples.wi_z[0]), 0.5, 1e-12) << key;
    EXPECT_EQ(m.conventions.at("angle-unit"), "rad (header)") << key;
  }
  for (const char* mark : {"* ", "! "}) {
    EXPECT_EQ(ReadText(std::string(mark) + "angle-unit: rad\n" + kRows).conventions.at("angle-unit"), "rad (header)");
  }
  const Measurement after = ReadText("theta_i,phi_i,theta_o,phi_o,brdf\n# angle_unit: rad\n0.5,0,0.7,3,1\n");
  EXPECT_NEAR(std::acos(after.samples.wi_z[0]), 0.5, 1e-12);
  EXPECT_EQ(ReadText("# value_kind: f-cos-o\n" + kRows).conventions.at("value-kind"), "f-cos-o (header)");
  EXPECT_EQ(ReadText("# Value kind: cosine corrected BRDF\n" + kRows).conventions.at("value-kind"), "f-cos-o (header)");
  EXPECT_EQ(ReadText("# incident-sense: propagation\n" + kRows).conventions.at("incident"), "propagation (header)");
  EXPECT_EQ(ReadText("# no_value: -1\n" + kRows + "0.5,0,0.8,3,-1\n").set_aside[SetAsideReason::kHole], 1U);
}

// A synthetic spectrum's file has a line of its truth for each parameter and channel.
TEST(CsvKeys, MayStandBelowThousandsOfComments) {
  std::string text;
  for (int i = 0; i < 5000; ++i) text += "# truth lobe." + std::to_string(i) + " = 0.5\n";
  text += "# angle-unit: rad\ntheta_i,phi_i,theta_o,phi_o,value\n0.5,0,0.5,3.1,0.25\n0.5,0,0.4,3.1,0.5\n";
  const Measurement measurement = ReadText(text);
  ASSERT_EQ(measurement.samples.size(), 2U);
  EXPECT_NEAR(measurement.samples.wi_z[0], std::cos(0.5), 1e-12);
}

// Beside their names, as people describe columns.
TEST(CsvKeys, UnitsOfColumnsStatedAboveThem) {
  for (const char* lines : {"# Column 1: theta_i (rad)\n# Column 2: phi_i (rad)\n# Column 3: theta_o (rad) - of the "
                            "detector\n# 4: phi_o (rad)\n",
                            "# theta_i: incidence angle in radians\n# phi_i: rad\n# theta_o = viewing angle [rad]\n# "
                            "phi_o: azimuth (rad)\n",
                            "# theta_i [rad]\n# phi_i [rad]\n# theta_o [rad]\n# phi_o (rad)\n",
                            "# theta_i, phi_i, theta_o, phi_o: rad; brdf: 1/sr\n",
                            "# - {name: theta_i, unit: rad, datatype: float64}\n# - {name: phi_i, unit: rad}\n"
                            "# - {name: theta_o, unit: rad}\n# - {name: phi_o, unit: rad}\n"}) {
    const Measurement m = ReadText(lines + kRows);
    ASSERT_EQ(m.samples.size(), 1U) << lines;
    EXPECT_NEAR(Norm(m.samples.wi(0) - FromSpherical(0.5, 0)), 0, 1e-12) << lines;
    EXPECT_NEAR(Norm(m.samples.wo(0) - FromSpherical(0.7, 3)), 0, 1e-12) << lines;
  }
  // Each for itself.
  const Measurement mixed = ReadText(
      "# theta_i: deg\n# phi_o: rad\n# brdf: in %\ntheta_i,phi_i,theta_o,phi_o,brdf\n30,0,40,1.5707963267948966,50\n");
  ExpectSample(mixed, 0, 30, 0, 40, 90, 0.5);
  EXPECT_DOUBLE_EQ(ReadText("# Column 5: BRDF (1e-3/sr)\n" + kRows).samples.values[0][0], 1e-3);
  // A range of angles is no statement of a unit, and what names say themselves is not overruled.
  const Measurement prose = ReadText("# theta_o: from 0 to 1 rad\n# Detector: Si (calibrated)\n" + kRows);
  EXPECT_NEAR(Norm(prose.samples.wo(0) - FromSpherical(DegreesToRadians(0.7), DegreesToRadians(3))), 0, 1e-12);
  EXPECT_NE(MessageOf("# theta_i [rad]\ntheta_i (deg),theta_o (deg),brdf\n10,20,1\n").find("take one of them away"),
            std::string::npos);
}

// A file that was put behind another, in other units.
TEST(CsvKeys, UnitsOfColumnsDoNotChangeAmidRows) {
  const std::string rows = "theta_i,theta_o,dphi,brdf\n10,10,180,0.3\n20,30,180,0.3\n";
  for (const char* line : {"# theta_i, theta_o: rad\n", "# theta_o [rad]\n", "# brdf: in %\n"}) {
    const std::string message = MessageOf(rows + line + "0.1,0.2,180,0.3\n");
    EXPECT_NE(message.find("line 4"), std::string::npos) << line << message;
    EXPECT_NE(message.find("put the parts into files of their own"), std::string::npos) << line << message;
  }
  for (const char* line : {"# theta_i, theta_o: deg\n", "# theta_o [deg]\n", "# brdf: 1/sr\n", "# sample 2 [rad]\n"})
    EXPECT_EQ(ReadText(rows + line + "30,30,180,0.3\n").samples.size(), 3U) << line;
  EXPECT_NE(MessageOf("# BRDF [%]\ntheta_i,theta_o,BRDF (1/sr)\n10,20,1\n").find("take one of them away"),
            std::string::npos);
}

TEST(CsvKeys, PartsOfASentenceAreNoKeyInCells) {
  EXPECT_NE(MessageOf("# AOI 30 deg, repeated at AOI 50 deg\ntheta_o,brdf\n10,1\n20,2\n").find("theta_i"),
            std::string::npos);
}

// Saved by a spreadsheet, which fills each line up to the number of columns.
TEST(CsvKeys, MayBeFollowedByEmptyCells) {
  for (const char* text : {"# angle-unit: rad,,,\n# columns: theta_o=x,,,\ntheta_i,x,dphi,brdf\n0.5,0.7,0,1\n",
                           "# angle-unit: rad;;;\n# columns: theta_o=x;;;\ntheta_i;x;dphi;brdf\n0.5;0.7;0;1\n"}) {
    const Measurement m = ReadText(text);
    ASSERT_EQ(m.samples.size(), 1U) << text;
    EXPECT_NEAR(std::acos(m.samples.wo_z[0]), 0.7, 1e-12) << text;
  }
}

TEST(CsvKeys, AFactorAndAUnitAreAProduct) {
  for (const char* unit : {"1e-3 1/sr", "10^-3 1/sr", "1e-3/sr", "10^-3 sr^-1"}) {
    const Measurement m =
        ReadText("theta_i,phi_i,theta_o,phi_o,BRDF (" + std::string(unit) + ")\n10,0,20,180,500\n10,0,30,180,250\n");
    EXPECT_NEAR(m.samples.values[0][0], 0.5, 1e-15) << unit;
  }
}

TEST(CsvKeys, HeadingsAreNoKeys) {
  const Measurement m =
      ReadText(",Incident,,Reflected,,\nNo.,polar,azimuth,polar,azimuth,BRDF\n1,10,20,30,40,0.5\n2,50,60,70,80,0.25\n");
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectSample(m, 1, 50, 60, 70, 80, 0.25);
}

TEST(CsvKeys, WhatResemblesAKeyIsSaid) {
  EXPECT_NE(MessageOf("# angle-unti: rad\n" + kRows).find("did you mean 'angle-unit'?"), std::string::npos);
  for (const char* prose : {"Repeats: 3", "Excluded: none", "X_Columns: No", "Column: 5"}) {
    const Measurement m = ReadText(std::string(prose) + "\n" + kRows);
    EXPECT_EQ(m.samples.size(), 1U) << prose;
    EXPECT_TRUE(HasRemark(m, "is not known (did you mean")) << prose;
  }
  EXPECT_TRUE(HasRemark(ReadText("# unit for most of it: rad\n" + kRows), "is not known and was not used"));
  EXPECT_TRUE(HasRemark(ReadText("# light convention: away\n" + kRows), "is not known and was not used"));
  // Synthetic files say the truth, which no reader takes for a unit.
  EXPECT_FALSE(HasRemark(ReadText("# truth, scale = 0.5\n" + kRows), "is not known"));
  EXPECT_TRUE(ReadText("# made by: N.N.\n# lobefit.alpha_x: 0.1\n# https://example.org/a-b\n" + kRows).remarks.empty());
}

// The words of an option that a file states for itself are the file's: its line is named.
TEST(CsvKeys, FaultsOfStatedOptionsAreOfTheFile) {
  for (const char* key : {"# columns: theta_i=", "# columns: bogus=1", "# where: pol", "# no-value: 0,,1",
                          "# exclude: bogus", "# repeated: often"}) {
    EXPECT_NE(MessageOf("\n" + std::string(key) + "\n" + kRows).find("line 2: "), std::string::npos) << key;
  }
  EXPECT_EQ(ReadText("# columns: incidence, azimuth, viewing, azimuth, value\n" + kRows).samples.size(), 1U);
}

TEST(Units, AnglesAreUnderstoodOrRefused) {
  const auto radians = [](const char* unit) {
    return ParseAngleUnit(unit) ? RadiansPerUnit(*ParseAngleUnit(unit)) : -1;
  };
  for (const char* unit : {"deg", "°", "Degrees", "º", "DEG", "grados"})
    EXPECT_DOUBLE_EQ(radians(unit), kPi / 180) << unit;
  EXPECT_DOUBLE_EQ(radians("gon"), kPi / 200);
  EXPECT_DOUBLE_EQ(radians("mrad"), 1e-3);
  EXPECT_DOUBLE_EQ(radians("arcmin"), kPi / 10800);
  EXPECT_DOUBLE_EQ(radians("rad"), 1);
  EXPECT_EQ(radians("grad"), -1);  // deg in German, gon in English
  EXPECT_EQ(radians("furlong"), -1);
  ExpectSample(ReadText("theta_i (gon),theta_o (mrad),f\n50,785.3981633974483,1\n"), 0, 45, 0, 45, 180, 1);
}

TEST(Units, WavelengthsAreUnderstood) {
  const auto nm = [](const char* unit, double number) {
    return ParseWavelengthUnit(unit) ? ParseWavelengthUnit(unit)->ToNm(number) : -1;
  };
  EXPECT_EQ(nm("nm", 550), 550);
  EXPECT_EQ(nm("µm", 0.5), 500);
  EXPECT_EQ(nm("μm", 0.5), 500);
  EXPECT_EQ(nm("m", 5e-7), 500);
  EXPECT_EQ(nm("cm^-1", 20000), 500);
  EXPECT_EQ(nm("cm⁻¹", 20000), 500);
  EXPECT_EQ(nm("Å", 5000), 500);
  EXPECT_NEAR(nm("eV", 2), 619.92, 0.01);
  EXPECT_NEAR(nm("THz", 500), 599.58, 0.01);
  // A stated unit is not second-guessed; without one the first rows decide for all.
  EXPECT_EQ(ReadText("wavelength_nm,theta_i,theta_o,f\n13.5,10,20,1\n").channels.wavelengths_nm[0], 13.5);
  EXPECT_EQ(ReadText("wavelength_um,theta_i,theta_o,f\n120,10,20,1\n").channels.wavelengths_nm[0], 120000);
  EXPECT_EQ(ReadText("wavelength,theta_i,theta_o,f\n0.55,10,20,1\n10.6,10,20,1\n").channels.wavelengths_nm,
            (std::vector<double>{550, 10600}));
}

TEST(Units, ScalesOfValuesAndTheirUncertainties) {
  EXPECT_NEAR(ReadText("theta_i,theta_o,BRDF (dB)\n10,20,-20\n").samples.values[0][0], 0.01, 1e-15);
  ReadOptions options;
  options.value_scale = "%";
  EXPECT_NEAR(ReadText("theta_i,theta_o,f\n10,20,50\n", options).samples.values[0][0], 0.5, 1e-15);
  options.value_scale = "furlong";
  EXPECT_NE(MessageOf("theta_i,theta_o,f\n10,20,50\n", options).find("--value-scale furlong: allowed are"),
            std::string::npos);
  // The same standard deviation said in five ways gives the same weights.
  const Measurement plain = ReadText("theta_i,theta_o,f,sigma\n10,20,0.5,0.05\n10,30,0.25,0.1\n");
  for (const char* text : {"theta_i,theta_o,f,relative uncertainty (%)\n10,20,0.5,10\n10,30,0.25,40\n",
                           "theta_i,theta_o,f,u_rel\n10,20,0.5,0.1\n10,30,0.25,0.4\n",
                           "theta_i,theta_o,f,U (k=2)\n10,20,0.5,0.1\n10,30,0.25,0.2\n",
                           "theta_i,theta_o,f,variance\n10,20,0.5,0.0025\n10,30,0.25,0.01\n",
                           "theta_i,theta_o,f (%),sigma\n10,20,50,5\n10,30,25,10\n",
                           "theta_i,theta_o,f (%),sigma (1/sr)\n10,20,50,0.05\n10,30,25,0.1\n"}) {
    const Measurement same = ReadText(text);
    ASSERT_EQ(same.samples.sigma.size(), 2U) << text;
    EXPECT_NEAR(same.samples.sigma[0], plain.samples.sigma[0], 1e-12) << text;
  }
  EXPECT_EQ(plain.samples.sigma, (std::vector<double>{0.05, 0.1}));
  // One that is missing counts as unknown.
  const Measurement missing =
      ReadText("theta_i,theta_o,f,sigma\n10,20,0.5,0.05\n10,30,0.25,\n10,40,0.25,-\n10,50,0.2,0\n");
  EXPECT_EQ(missing.samples.size(), 4U);
  EXPECT_TRUE(HasRemark(missing, "3 samples have no uncertainty"));
}

TEST(CsvKeys, ASentenceMayStateTheUnit) {
  for (const char* line : {"# all angles are given in radians", "Angles in radians", "# Angles are radians."}) {
    const Measurement m = ReadText(std::string(line) + "\ntheta_i,theta_o,dphi,brdf\n0.5,1,0,2\n");
    EXPECT_EQ(m.conventions.at("angle-unit"), "rad (header)") << line;
  }
  for (const char* line : {"# at an angle of 30 deg", "# angles in radians or degrees"}) {
    const Measurement m = ReadText(std::string(line) + "\ntheta_i,theta_o,dphi,brdf\n0.5,1,0,2\n");
    EXPECT_EQ(m.conventions.at("angle-unit"), "deg (default)") << line;
  }
}

// What a head states of the light in its own words.
TEST(CsvKeys, AnglesAndWavelengthsInPhrases) {
  for (const char* line : {"# theta_i=30, phi_i=90", "# incident zenith: 30 deg, azimuth: 90 deg",
                           "# incident zenith = 30; incident azimuth = 90", "Scan 1, phi_i 90 deg\nAOI 30 deg"}) {
    const Measurement m = ReadText(std::string(line) + "\ntheta_o,phi_o,f\n45,270,2\n");
    ASSERT_EQ(m.samples.size(), 1U) << line;
    ExpectSample(m, 0, 30, 90, 45, 270, 2);
  }
  const Measurement laser = ReadText("# Laser wavelength 632.8 nm\n# Incidence angle 30 deg.\ntheta_o,f\n45,2\n");
  ExpectSample(laser, 0, 30, 0, 45, 180, 2);
  EXPECT_EQ(laser.channels.wavelengths_nm, (std::vector<double>{632.8}));
  const Measurement blocks =
      ReadText("Scan 1, incidence 10 deg\ntheta_o,f\n45,1\nScan 2, incidence 30 deg\ntheta_o,f\n45,2\n");
  ASSERT_EQ(blocks.samples.size(), 2U);
  ExpectSample(blocks, 1, 30, 0, 45, 180, 2);
  // A list is no angle of the file.
  EXPECT_NE(MessageOf("# angle of incidence 10 20 30\ntheta_o,f\n45,2\n").find("'# theta_i: 30'"), std::string::npos);
  EXPECT_NE(MessageOf("# incident direction: 30, 90\ntheta_o,f\n45,2\n").find("'# theta_i: 30'"), std::string::npos);
}

// Titles mention it amid other words; that is said where it is used.
TEST(CsvKeys, TheAngleOfIncidenceAmidATitle) {
  for (const char* line :
       {"BRDF at 30 deg incidence", "# BRDF measured at 30\u00b0 incidence angle", "Measured at AOI 30 degrees",
        "30 deg angle of incidence", "Title: 30\u00b0 AOI", "# white tile, lit at an angle of incidence of 30 deg"}) {
    const Measurement m = ReadText(std::string(line) + "\ntheta_o,f\n45,2\n");
    ASSERT_EQ(m.samples.size(), 1U) << line;
    ExpectSample(m, 0, 30, 0, 45, 180, 2);
    EXPECT_THAT(m.remarks, testing::Contains(testing::HasSubstr("the angle of incidence is 30"))) << line;
  }
  for (const char* line : {"Sample A, theta_i = 30", "Sample: white tile; angle of incidence = 30.0 deg"})
    ExpectSample(ReadText(std::string(line) + "\ntheta_o;f\n45;2\n"), 0, 30, 0, 45, 180, 2);
  const Measurement blocks =
      ReadText("BRDF at 10 deg incidence\ntheta_o,f\n45,1\nBRDF at 30 deg incidence\ntheta_o,f\n45,2\n");
  ExpectSample(blocks, 1, 30, 0, 45, 180, 2);
  // A column is what counts, and of several angles none is that of all rows.
  const Measurement column = ReadText("# tile, 8 deg incidence in the sphere\ntheta_i,theta_o,f\n30,45,2\n");
  ExpectSample(column, 0, 30, 0, 45, 180, 2);
  EXPECT_THAT(column.remarks, testing::Not(testing::Contains(testing::HasSubstr("incidence is 8"))));
  for (const char* line :
       {"BRDF at 0, 30 and 60 deg incidence", "scan from 10 to 60 deg incidence",
        "tile at 8 deg incidence, sample at 30 deg incidence", "detector at 30 deg",
        "detector step 0.5 deg, incidence fixed", "tilted 2 deg from incidence plane", "2 deg incidence plane",
        "resolution 0.1 deg (theta_i, theta_o)", "half angle of the source 1.5 deg at incidence"}) {
    EXPECT_NE(MessageOf(std::string(line) + "\ntheta_o;f\n45;2\n").find("'# theta_i: 30'"), std::string::npos) << line;
  }
}

TEST(CsvKeys, UnitsInLists) {
  for (const char* line : {"# Units: rad, 1e-2/sr", "# unit of theta_i: rad\n# BRDF unit: 1e-2/sr",
                           "# Winkel: rad\n# BRDF values given in %", "# angles in radians\n# values in %"}) {
    const Measurement m =
        ReadText(std::string(line) + "\ntheta_i,theta_o,f\n0.5235987755982988,0.7853981633974483,50\n");
    ExpectSample(m, 0, 30, 0, 45, 180, 0.5);
  }
  EXPECT_TRUE(HasRemark(ReadText("# Units: rad, furlongs\n" + kRows), "is not known and was not used"));
  EXPECT_TRUE(HasRemark(ReadText("# scale factor: 0.01\n" + kRows), "is not known and was not used"));
}

TEST(CsvKeys, WhatIsStatedAndNotUsedIsSaid) {
  EXPECT_TRUE(HasRemark(ReadText("# Polarization: s\n" + kRows), "line 1: the polarisation is 's'"));
  EXPECT_FALSE(HasRemark(ReadText("# Polarization: unpolarised\n" + kRows), "the polarisation is"));
  EXPECT_TRUE(HasRemark(ReadText("# relative uncertainty: 5 % (k=2)\n" + kRows), "for all values was not used"));
}

TEST(Units, UncertaintiesInDecibelsAndParts) {
  const auto sigma = [](const std::string& name, const char* number) {
    return ReadText("theta_i,theta_o,f," + name + "\n10,20,0.5," + number + "\n").samples.sigma.at(0);
  };
  EXPECT_NEAR(sigma("uncertainty (dB)", "0.2"), 0.5 * 0.2 * std::log(10) / 10, 1e-12);
  EXPECT_NEAR(sigma("sigma [rel]", "0.1"), 0.05, 1e-12);
  EXPECT_NEAR(sigma("sigma_rel [ppm]", "1000"), 0.0005, 1e-12);
  for (const char* name : {"std dev", "stderr", "error bar", "s.d.", "measurement uncertainty", "BRDF err"})
    EXPECT_NEAR(sigma(name, "0.1"), 0.1, 1e-12) << name;
  EXPECT_NEAR(sigma("std dev (%)", "10"), 0.05, 1e-12);
  EXPECT_NEAR(sigma("RSD (%)", "10"), 0.05, 1e-12);
}

TEST(CsvKeys, LightsByTheirWavelength) {
  const std::string rows = "theta_i,theta_o,brdf\n30,40,1\n";
  for (const char* line : {"# 550 nm", "# 550nm", "# Laser: 550 nm", "# Filter 550 nm", "# 0.55 um", "Laser,550,nm"})
    EXPECT_EQ(ReadText(std::string(line) + "\n" + rows).channels.wavelengths_nm, std::vector<double>{550}) << line;
  for (const char* line : {"# Filter 10 nm", "# step: 550 nm", "# 550 mm", "# 550", "# roughness: 550 nm"})
    EXPECT_TRUE(ReadText(std::string(line) + "\n" + rows).channels.wavelengths_nm.empty()) << line;
  const Measurement m = ReadText("# 450 nm\n" + rows + "# 650 nm\n30,40,2\n");
  ASSERT_EQ(m.channels.wavelengths_nm, (std::vector<double>{450, 650}));
  EXPECT_EQ(m.samples.values[1][0], 2);
}

// Prose amid the rows is looked at once, but what begins alike may state something.
TEST(CsvKeys, LightsAndAnglesBehindProseAmidTheRows) {
  const std::string rows = "theta_o,dphi,brdf\n40,180,1\n";
  const Measurement lights = ReadText("# 450 nm\n# theta_i 30\n" + rows + "# 2 scans averaged\n# 650 nm\n40,180,2\n");
  EXPECT_EQ(lights.channels.wavelengths_nm, (std::vector<double>{450, 650}));
  const Measurement angles = ReadText("# theta_i 30\n" + rows + "# theta of scan 1\n# theta_i 45\n40,180,2\n");
  ASSERT_EQ(angles.samples.size(), 2U);
  EXPECT_NEAR(RadiansToDegrees(std::acos(angles.samples.wi_z[1])), 45, 1e-9);
}

TEST(CsvKeys, AnglesAmidTheRowsThatAreNoKeysAreAskedAbout) {
  const std::string head = "# theta_i 30\ntheta_o,dphi,brdf\n10,180,1\n# ", rows = "\n20,180,2\n";
  for (const char* line : {"Scan 2: theta_i 45", "theta_i 45 scan 2", "scan 2 theta_i 45", "next: AOI=45 deg",
                           "Scan 2 - incidence angle 45 deg", "angle of incidence is 45 degrees"}) {
    EXPECT_THAT(MessageOf(head + line + rows), testing::HasSubstr("line 4: '" + std::string(line) + "' names another"));
  }
  // Said of the same angle first.
  EXPECT_THAT(MessageOf(head + "scan 1 theta_i 30\n15,180,1\n# scan 2 theta_i 45" + rows),
              testing::HasSubstr("line 6: 'scan 2 theta_i 45'"));
  for (const char* line :
       {"scan 2 theta_i 30", "Scan 2: 45 rows", "next scan", "lamp current 4.5 A", "step 5 of theta_o"})
    EXPECT_EQ(ReadText(head + line + rows).samples.size(), 2U) << line;
}

TEST(CsvKeys, KeysInQuotes) {
  EXPECT_EQ(ReadText("\"AOI: 30\"\ntheta_o,brdf\n40,1\n").samples.size(), 1U);
  EXPECT_EQ(ReadText("\"AOI: 30, sample 7\"\ntheta_o,brdf\n40,1\n").samples.size(), 1U);
}

}  // namespace
}  // namespace lobefit
