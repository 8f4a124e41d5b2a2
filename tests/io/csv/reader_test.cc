#include <cmath>

#include "tests/io/csv/read_csv.h"

namespace lobefit {
namespace {

double F(const Measurement& measurement, std::size_t sample, std::size_t channel = 0) {
  return measurement.samples.values[channel][sample];
}

TEST(Csv, ReadsNamedColumnsInAnyOrder) {
  const Measurement m = ReadText("B,phi_o,theta_o,R,theta_i,phi_i,G\n3,40,30,1,10,20,2\n");
  ASSERT_EQ(m.samples.size(), 1U);
  EXPECT_EQ(m.format, "csv");
  ExpectDirection(m.samples.wi(0), 10, 20);
  ExpectDirection(m.samples.wo(0), 30, 40);
  EXPECT_EQ(m.channels.names, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(F(m, 0, 0), 1);
  EXPECT_EQ(F(m, 0, 1), 2);
  EXPECT_EQ(F(m, 0, 2), 3);
  EXPECT_EQ(m.samples.origin[0], 2U);
  EXPECT_FALSE(m.isotropic);
}

TEST(Csv, LineEndsSeparatorsAndByteOrderMarkDoNotMatter) {
  for (const char* text : {"theta_i,phi_i,theta_o,phi_o,f\r\n10,20,30,40,0.5\r\n\r\n50,60,70,80,0.25",
                           "\xef\xbb\xbftheta_i;phi_i;theta_o;phi_o;f\n10;20;30;40;0.5\n50;60;70;80;0.25\n",
                           "theta_i\tphi_i\ttheta_o\tphi_o\tf\n10\t20\t30\t40\t0.5\n# note\n50\t60\t70\t80\t0.25\n",
                           "theta_i phi_i  theta_o phi_o f\n 10 20 30 40 0.5\n50 60 70  80 0.25\n",
                           "# theta_i,phi_i,theta_o,phi_o,f\n10,20,30,40,0.5\n50,60,70,80,0.25\n"}) {
    const Measurement m = ReadText(text);
    ASSERT_EQ(m.samples.size(), 2U) << text;
    ExpectDirection(m.samples.wi(1), 50, 60);
    ExpectDirection(m.samples.wo(1), 70, 80);
    EXPECT_EQ(F(m, 0), 0.5);
    EXPECT_EQ(F(m, 1), 0.25);
  }
}

TEST(Csv, HeaderKeysStateUnitKindAndSense) {
  const Measurement m = ReadText(
      "# angle-unit: rad\n# value-kind = f-cos-o\n# incident: propagation\n# lobefit.alpha_x: 0.1\n"
      "theta_i,phi_i,theta_o,phi_o,f\n0.1,0.2,1.0,0.4,2\n");
  ExpectDirection(m.samples.wi(0), RadiansToDegrees(0.1), RadiansToDegrees(0.2) + 180);
  ExpectDirection(m.samples.wo(0), RadiansToDegrees(1.0), RadiansToDegrees(0.4));
  EXPECT_NEAR(F(m, 0), 2 / std::cos(1.0), 1e-15);
  EXPECT_EQ(m.conventions.at("angle-unit"), "rad (header)");
  EXPECT_EQ(m.conventions.at("value-kind"), "f-cos-o (header)");
  EXPECT_EQ(m.conventions.at("incident"), "propagation (header)");
}

TEST(Csv, OptionsOverrideHeaderAndNames) {
  ReadOptions options;
  options.angle_unit = AngleUnit::kRadians;
  options.value_kind = ValueKind::kReflectanceFactor;
  options.incident_sense = IncidentSense::kTowardsSource;
  const Measurement m = ReadText(
      "# angle-unit: deg\n# value-kind: f-cos-o\n# incident: propagation\ntheta_i_deg,phi_i,theta_o,phi_o,f\n"
      "0.1,0.2,1.0,0.4,2\n",
      options);
  ExpectDirection(m.samples.wi(0), RadiansToDegrees(0.1), RadiansToDegrees(0.2));
  EXPECT_NEAR(F(m, 0), 2 / kPi, 1e-15);
  EXPECT_EQ(m.conventions.at("value-kind"), "pi-f (option)");
}

TEST(Csv, EveryValueKindBecomesTheSameBrdf) {
  const double f = 0.7, cos_i = std::cos(DegreesToRadians(20)), cos_o = std::cos(DegreesToRadians(50));
  const std::vector<std::pair<std::string, double>> kinds = {
      {"f", f},          {"f-cos-o", f * cos_o},   {"f-cos-i", f * cos_i},
      {"pi-f", kPi * f}, {"intensity", f * cos_o}, {"pi-f-cos-o", kPi * f * cos_o}};
  for (const auto& [kind, value] : kinds) {
    const Measurement m = ReadText("# value-kind: " + kind + "\ntheta_i,phi_i,theta_o,phi_o,value\n20,0,50,10," +
                                   std::to_string(value) + "\n");
    EXPECT_NEAR(F(m, 0), f, 2e-6) << kind;
  }
}

TEST(Csv, SignedAnglesLieOnTheOtherSide) {
  const Measurement with_phi = ReadText("theta_i,phi_i,theta_o,phi_o,f\n-10,20,-30,40,1\n");
  ExpectDirection(with_phi.samples.wi(0), 10, 200);
  ExpectDirection(with_phi.samples.wo(0), 30, 220);
  // Without azimuths theta_o = theta_i is the mirror direction.
  const Measurement in_plane = ReadText("theta_i,theta_o,f\n30,30,1\n30,-40,2\n");
  ExpectDirection(in_plane.samples.wi(0), 30, 0);
  ExpectDirection(in_plane.samples.wo(0), 30, 180);
  ExpectDirection(in_plane.samples.wo(1), 40, 0);
}

TEST(Csv, DeltaPhiCountsFromTheLight) {
  const Measurement m = ReadText("theta_i,theta_o,dphi,f\n30,40,180,1\n30,40,0,2\n");
  ExpectDirection(m.samples.wi(0), 30, 0);
  ExpectDirection(m.samples.wo(0), 40, 180);
  ExpectDirection(m.samples.wo(1), 40, 0);
  EXPECT_TRUE(m.isotropic);
  const Measurement turned = ReadText("theta_i,phi_i,theta_o,dphi,f\n30,25,40,180,1\n");
  ExpectDirection(turned.samples.wo(0), 40, 205);
  EXPECT_FALSE(turned.isotropic);
}

TEST(Csv, AzimuthIsThatOfTheReceiversPlane) {
  const Measurement m = ReadText("azimuth_deg,incidence_deg,receive_deg,RT\n-90,30,30,1\n90,30,30,1\n0,30,10,1\n");
  ExpectDirection(m.samples.wo(0), 30, 180);  // mirror
  ExpectDirection(m.samples.wo(1), 30, 0);    // back to the light
  ExpectDirection(m.samples.wo(2), 10, 270);  // across
  EXPECT_NEAR(F(m, 0), 1 / (kPi * std::cos(DegreesToRadians(30))), 1e-15);
  // A turned sample turns both directions backwards in its frame.
  const Measurement turned =
      ReadText("# sample-rotation-deg: 20\nazimuth_deg,incidence_deg,receive_deg,RT\n-90,30,30,1\n");
  ExpectDirection(turned.samples.wi(0), 30, -20);
  ExpectDirection(turned.samples.wo(0), 30, 160);
}

TEST(Csv, WavelengthsAsColumnsAndAsRows) {
  const Measurement columns = ReadText("theta_i,theta_o,450nm,550 nm,0.65um\n10,20,1,2,3\n");
  EXPECT_EQ(columns.channels.wavelengths_nm, (std::vector<double>{450, 550, 650}));
  EXPECT_EQ(columns.channels.names[2], "650nm");
  const Measurement rows = ReadText(
      "lambda,theta_i,theta_o,f_r11\n0.55,10,20,2\n0.45,10,20,1\n0.55,10,30,4\n0.45,10,30,3\n0.45,10,40,5\n"
      "0.45,10,20,9\n");
  ASSERT_EQ(rows.samples.size(), 2U);
  EXPECT_EQ(rows.channels.wavelengths_nm, (std::vector<double>{450, 550}));
  EXPECT_EQ(F(rows, 0, 0), 1);
  EXPECT_EQ(F(rows, 0, 1), 2);
  EXPECT_EQ(F(rows, 1, 0), 3);
  EXPECT_EQ(rows.set_aside[SetAsideReason::kHole], 1U);       // 40 degrees lacks 550 nm
  EXPECT_EQ(rows.set_aside[SetAsideReason::kDuplicate], 1U);  // 20 degrees has 450 nm twice
}

TEST(Csv, RowsOfAWavelengthKeepTheirUncertainties) {
  const Measurement m =
      ReadText("lambda,theta_i,theta_o,f,sigma\n550,10,20,2,0.3\n450,10,20,1,0.4\n550,10,30,2,3\n450,10,30,1,4\n");
  const Measurement same = ReadText(
      "theta_i,theta_o,450nm,550nm,sigma\n10,20,1,2,0.3535533905932738\n"
      "10,30,1,2,3.5355339059327378\n");
  ASSERT_EQ(m.samples.sigma.size(), 2U);
  ASSERT_EQ(same.samples.sigma.size(), 2U);
  EXPECT_NEAR(m.samples.sigma[1] / m.samples.sigma[0], 10, 1e-12);
  for (const std::size_t i : {0, 1}) EXPECT_NEAR(m.samples.sigma[i], same.samples.sigma[i], 1e-14);

  const Measurement weighted = ReadText(
      "lambda,theta_i,theta_o,f,weight\n550,10,20,2,1\n450,10,20,1,3\n550,10,30,2,6\n450,10,30,1,6\n450,9,9,1,0\n");
  ASSERT_EQ(weighted.samples.weight.size(), 2U);
  EXPECT_NEAR(weighted.samples.weight[1] / weighted.samples.weight[0], 3, 1e-15);
  EXPECT_EQ(weighted.set_aside[SetAsideReason::kFlagged], 1U);
}

TEST(Csv, RepeatedRowsOfAWavelengthAreMergedWhenAsked) {
  ReadOptions options;
  options.repeated = RepeatedRows::kMean;
  const Measurement m = ReadText(
      "lambda,theta_i,theta_o,f\n550,10,20,2\n450,10,20,1\n550,10,20,4\n450,10,20,3\n450,10,20,9\n550,10,30,1\n"
      "450,10,30,1\n",
      options);
  ASSERT_EQ(m.samples.size(), 2U);
  EXPECT_EQ(F(m, 0, 0), 2);
  EXPECT_EQ(F(m, 0, 1), 3);
  EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 1U);  // the third row of 450 nm has no fellow at 550 nm
}

TEST(Csv, CountsWhatItSetsAside) {
  const Measurement m =
      ReadText("theta_i,theta_o,f\n10,20,1\n10,20,2\n90,20,3\n10,30,nan\n10,40,inf\n10,95,1\nnan,3,1\n");
  EXPECT_EQ(m.samples.size(), 1U);
  EXPECT_EQ(F(m, 0), 1);
  EXPECT_EQ(m.set_aside[SetAsideReason::kDuplicate], 1U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kBelowHorizon], 2U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kNotFinite], 3U);
}

TEST(Csv, ChosenColumnAndIgnoredOnes) {
  const std::string text = "theta_i,theta_o,first,second,f\n10,20,1,x,3\n";
  ReadOptions options;
  options.value_column = "First";
  const Measurement m = ReadText(text, options);
  EXPECT_EQ(F(m, 0), 1);
  EXPECT_EQ(m.conventions.at("value-column"), "first (option)");
  ASSERT_EQ(m.remarks.size(), 1U);
  EXPECT_EQ(m.remarks[0], "columns not used: second, f");
  EXPECT_EQ(F(ReadText(text), 0), 3);
  EXPECT_EQ(ReadText(text).remarks[0], "columns not used: first, second");
  // A name that speaks of an angle is not passed over.
  EXPECT_THROW(ReadText("theta_i,theta_o,tilt,f\n10,20,1,3\n"), InputError);
}

TEST(Csv, WeightsAndUncertaintiesAreKept) {
  const Measurement weight = ReadText("theta_i,theta_o,f,weight\n10,20,1,1\n10,30,1,3\n10,40,1,0\n");
  EXPECT_EQ(weight.samples.weight, (std::vector<double>{0.5, 1.5}));
  EXPECT_EQ(weight.set_aside[SetAsideReason::kFlagged], 1U);
  const Measurement sigma = ReadText("theta_i,theta_o,f,sigma\n10,20,1,0.1\n10,30,1,0.1\n10,40,1,0.3\n");
  EXPECT_EQ(sigma.samples.sigma, (std::vector<double>{0.1, 0.1, 0.3}));
  EXPECT_TRUE(sigma.samples.weight.empty());
}

TEST(Csv, RepeatedRowsAreMergedWhenAsked) {
  const std::string text = "theta_i,theta_o,f\n10,20,1\n10,30,4\n10,20,3\n10,40,5\n";
  EXPECT_EQ(F(ReadText(text), 0), 1);
  ReadOptions options;
  options.repeated = RepeatedRows::kMean;
  const Measurement m = ReadText(text, options);
  ASSERT_EQ(m.samples.size(), 3U);
  EXPECT_EQ(F(m, 0), 2);
  EXPECT_EQ(m.set_aside[SetAsideReason::kDuplicate], 0U);
  EXPECT_EQ(m.samples.sigma.size(), 3U);
  // Standard deviation of 1 and 3 about 2: sqrt(2) / 2 of the mean.
  EXPECT_EQ(m.remarks[0], "2 repeated rows were merged to 1; a row scatters by 70.7 % of its mean");
}

TEST(Csv, ANoiseFloorIsTheUncertaintyOfEveryReading) {
  ReadOptions options;
  options.noise_floor = 0.01;
  const Measurement m = ReadText("theta_i,theta_o,f\n10,20,0.001\n10,30,100\n10,40,0.002\n", options);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(m.samples.sigma[i] * m.samples.wi_z[i], 0.01, 1e-15);
  EXPECT_EQ(m.conventions.at("noise-floor"), "0.01 (option)");
}

TEST(Csv, KeysStateTheInstrument) {
  const std::string row = "theta_i,phi_i,theta_o,phi_o,Y\n10,0,20,0,1\n";
  const Measurement stated = ReadText("# source: 2\n# detector = 1.5 deg\n# mean: plain\n" + row);
  EXPECT_DOUBLE_EQ(*stated.instrument.source, DegreesToRadians(2));
  EXPECT_DOUBLE_EQ(*stated.instrument.detector, DegreesToRadians(1.5));
  EXPECT_TRUE(*stated.instrument.plain_mean);
  // Prose that begins with the same words.
  const Measurement uncertain = ReadText("# source: 2 +- 0.1 deg\n# detector: 0.5 x 3 deg\n" + row);
  EXPECT_DOUBLE_EQ(*uncertain.instrument.source, DegreesToRadians(2));
  EXPECT_DOUBLE_EQ(*uncertain.instrument.source_prior, DegreesToRadians(0.1));
  EXPECT_DOUBLE_EQ(*uncertain.instrument.detector, DegreesToRadians(0.5));
  EXPECT_DOUBLE_EQ(*uncertain.instrument.detector_across, DegreesToRadians(3));
  EXPECT_FALSE(uncertain.instrument.detector_prior);
  for (const char* bad :
       {"# detector: 2 +- 0\n", "# detector: 0 +- 0.1\n", "# source: 1 x 3\n", "# detector: 1 x 40\n"})
    EXPECT_THROW(ReadText(bad + row), InputError) << bad;
  const Measurement prose = ReadText("# source: xenon lamp\n# detector: InGaAs\n# mean: of 3 scans\n" + row);
  EXPECT_FALSE(prose.instrument.source || prose.instrument.detector || prose.instrument.plain_mean);
  const Measurement whole =
      ReadText("# drift: 0.03\n# alignment: 0.2 deg\n# offset: true\n# noise: floor=0.002, relative = 0.03\n" + row);
  EXPECT_EQ(whole.instrument.drift, StatedDrift{0.03});
  EXPECT_DOUBLE_EQ(*whole.instrument.alignment, DegreesToRadians(0.2));
  EXPECT_TRUE(*whole.instrument.offset);
  EXPECT_EQ(whole.instrument.noise, (StatedNoise{0.002, 0.03, 0}));
  EXPECT_TRUE(whole.remarks.empty());
  EXPECT_EQ(ReadText("# Drift: auto\n# noise-model: poisson=1e-4,relative=0.01\n" + row).instrument.drift,
            StatedDrift{});
  for (const char* bad : {"# drift: 3\n", "# drift: -0.1\n", "# alignment: 0\n", "# alignment: 9 deg\n",
                          "# noise: floor=0.002\n", "# noise: floor=a, relative=0.1\n", "# noise: relative=0.1\n",
                          "# noise: floor=0.1, relative=2\n", "# noise-model: knee=1, relative=0.1, floor=1\n"})
    EXPECT_THROW(ReadText(bad + row), InputError) << bad;
  const Measurement words =
      ReadText("# drift: below 1 % per hour\n# alignment: by laser\n# offset: subtracted\n# noise: low\n" + row);
  EXPECT_EQ(words.instrument, StatedInstrument{});
  // Half a turn on the stage: directions are those of the sample, and the alignment learns of it.
  const Measurement turned = ReadText("# turned: true\n" + row);
  EXPECT_NEAR(turned.samples.wi_x[0], -std::sin(DegreesToRadians(10)), 1e-12);
  EXPECT_DOUBLE_EQ(turned.samples.sample_azimuth.at(0), kPi);
  EXPECT_TRUE(stated.samples.sample_azimuth.empty());
  try {
    ReadText("# detector: 95\n" + row);
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_NE(
        std::string(error.what()).find("detector is '95'; the half angle of its disc is allowed, 0 to 30 degrees"),
        std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace lobefit
