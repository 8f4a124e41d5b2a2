// Sweeps change one thing of an experiment, and leave it one that can be.
#include "lobefit/validate/sweep.h"

#include <cmath>

#include "tests/validate/brushed.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

ExperimentRequest Brushed() {
  ExperimentRequest request;
  request.truth = test::BrushedMetal();
  request.layout.goniometer.polar_angles = {0.3, 0.8};
  request.layout.goniometer.azimuths = {0, 1};
  request.layout.goniometer.detector_step = DegreesToRadians(30);
  request.recipe = DefaultRecipe(request.truth.model, "test");
  return request;
}

// A round GGX lobe.
ExperimentRequest Round() {
  ExperimentRequest request = Brushed();
  request.truth.model.lobes[0].ndf = Ndf::kGgx;
  request.truth.values[1] = request.truth.values[0];
  request.truth.values[3] = request.truth.values[4] = {0};
  request.recipe = DefaultRecipe(request.truth.model, "test");
  return request;
}

Truth TruthAt(const std::string& sweep, const ExperimentRequest& base = Brushed()) {
  return ParseSweep(sweep, base).points.at(0).request.truth;
}

TEST(Sweep, PointsDifferInOneThing) {
  const ExperimentRequest base = Brushed();
  const Sweep sweep = ParseSweep(" alpha_x = 0.1, 0.2 ,1e-1", base);
  EXPECT_EQ(sweep.name, "alpha_x");
  EXPECT_TRUE(sweep.numeric);
  ASSERT_EQ(sweep.points.size(), 3U);
  EXPECT_EQ(sweep.points[2].value, "1e-1");
  for (std::size_t i = 0; i < base.truth.values.size(); ++i) {
    EXPECT_EQ(sweep.points[1].request.truth.values[i], i == 0 ? std::vector<double>{0.2} : base.truth.values[i]);
  }
  EXPECT_EQ(sweep.points[0].request.layout.goniometer.azimuths, base.layout.goniometer.azimuths);
  EXPECT_FALSE(ParseSweep("masking=smith-height,smith-separable", base).numeric);
}

TEST(Sweep, ShapesKeepWhatTheySay) {
  const Truth alpha = TruthAt("alpha=0.07");
  EXPECT_DOUBLE_EQ(alpha.values[0][0], 0.07);
  EXPECT_DOUBLE_EQ(alpha.values[1][0], 0.07 * 0.11 / 0.35);
  const Truth ratio = TruthAt("ratio=5");
  EXPECT_DOUBLE_EQ(ratio.values[0][0], 0.35);
  EXPECT_DOUBLE_EQ(ratio.values[1][0], 0.07);
  ExperimentRequest tilted = Brushed();
  tilted.truth.values[2] = {0.1};
  const Truth tilt = TruthAt("tilt=-12", tilted);
  EXPECT_EQ(tilt.values[2][0], 0) << "the other tilt goes";
  EXPECT_DOUBLE_EQ(tilt.values[3][0], DegreesToRadians(-12));
  EXPECT_DOUBLE_EQ(TruthAt("theta_z_deg=-30").values[4][0], DegreesToRadians(-30));
  EXPECT_EQ(TruthAt("f0=0.25").values[5], (std::vector<double>(3, 0.25))) << "all channels";
}

// alpha_y of a round lobe is alpha_x: else the truth would be a lobe that its model has not, and every fit of it wrong.
TEST(Sweep, RoundLobesStayRound) {
  for (const char* sweep : {"alpha=0.1", "alpha_x=0.1"}) {
    const Truth truth = TruthAt(sweep, Round());
    EXPECT_EQ(truth.values[0], std::vector<double>{0.1}) << sweep;
    EXPECT_EQ(truth.values[1], std::vector<double>{0.1}) << sweep;
  }
  ExperimentRequest request = ParseSweep("alpha_x=0.1", Round()).points.at(0).request;
  Experiment experiment = MakeExperiment(request);
  experiment.fit.starts = 3;
  const Trial trial = RunTrial(experiment, 0);
  EXPECT_EQ(trial.error, "");
  EXPECT_LT(trial.difference, 1e-6) << "a fit without noise gives the truth back";
  EXPECT_FALSE(trial.misfit);
}

TEST(Sweep, WhatTheModelTiesIsRefused) {
  const auto refused = [](const std::string& sweep, const ExperimentRequest& base, const char* words) {
    EXPECT_THAT([&] { ParseSweep(sweep, base); }, ThrowsMessage<UsageError>(HasSubstr(words))) << sweep;
  };
  refused("ratio=2", Round(), "--sweep ratio: the truth's model has no alpha_y of its own");
  refused("tilt=5", Round(), "--sweep tilt: the truth's model has no theta_y_deg of its own");
  refused("alpha_y=0.2", Round(), "'alpha_y' cannot be swept");
  ExperimentRequest lambert = Brushed();
  lambert.truth.model.lobes.clear();
  lambert.truth.values = {{0.5, 0.4, 0.3}};
  refused("alpha=0.1", lambert, "has no alpha_x");
  refused("tilt=1", lambert, "has no theta_y_deg");
  EXPECT_EQ(TruthAt("diffuse=0.2", lambert).values[0], (std::vector<double>(3, 0.2)));
}

TEST(Sweep, ValuesThatNoExperimentCanHaveAreRefused) {
  for (const char* sweep : {"alpha=0", "alpha=-0.1", "alpha=2", "alpha=1e-9", "ratio=0", "ratio=-2", "ratio=1e6",
                            "tilt=200", "f0=2", "alpha_x=0"}) {
    EXPECT_THAT([&] { TruthAt(sweep); }, ThrowsMessage<UsageError>(HasSubstr("which lies outside ["))) << sweep;
  }
  for (const char* sweep : {"alpha=", "alpha=x", "alpha=nan", "alpha=0.1,,0.2", "ratio=1;2", "theta_y_deg=inf"})
    EXPECT_THAT([&] { TruthAt(sweep); }, ThrowsMessage<UsageError>(HasSubstr("' is not a number"))) << sweep;
  for (const char* sweep : {"incidences=0", "incidences=2.5", "azimuths=1001", "azimuths=-1"})
    EXPECT_THAT([&] { TruthAt(sweep); }, ThrowsMessage<UsageError>(HasSubstr("must be a whole number from 1 to 1000")));
  EXPECT_THAT([] { TruthAt("detector-step=0.1"); }, ThrowsMessage<UsageError>(HasSubstr("values from 0.2 to 45")));
  EXPECT_THAT([] { TruthAt("metric=logs"); }, ThrowsMessage<UsageError>(HasSubstr("'logs' is unknown (did you mean")));
  EXPECT_THAT([] { TruthAt("multiplicative=-1"); }, ThrowsMessage<UsageError>(HasSubstr("with a number in")));
  EXPECT_THAT([] { TruthAt("alpha"); }, ThrowsMessage<UsageError>(HasSubstr("write NAME=VALUE,VALUE,...")));
  EXPECT_THAT([] { TruthAt("alhpa=1"); },
              ThrowsMessage<UsageError>(AllOf(HasSubstr("did you mean 'alpha'"), HasSubstr("multiplicative"))));
  EXPECT_THAT([] { ParseSweep("x=1", Round()); }, ThrowsMessage<UsageError>(Not(HasSubstr("theta_z_deg"))));
}

// Lights evenly from 5 to 70 degrees; azimuths that part half a turn.
TEST(Sweep, LayoutsAreSpreadEvenly) {
  const auto layout = [](const char* sweep) {
    return ParseSweep(sweep, Brushed()).points.at(0).request.layout.goniometer;
  };
  const std::vector<double> polar = layout("incidences=14").polar_angles;
  ASSERT_EQ(polar.size(), 14U);
  for (std::size_t k = 0; k < 14; ++k) EXPECT_NEAR(polar[k], DegreesToRadians(5. * static_cast<double>(k + 1)), 1e-12);
  EXPECT_NEAR(layout("incidences=1").polar_angles.at(0), DegreesToRadians(37.5), 1e-12);
  EXPECT_EQ(layout("azimuths=1").azimuths, std::vector<double>{0});
  const std::vector<double> azimuths = layout("azimuths=4").azimuths;
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(azimuths.at(k), kPi / 4 * static_cast<double>(k), 1e-12);
  EXPECT_NEAR(layout("detector-step=7").detector_step, DegreesToRadians(7), 1e-12);
}

TEST(MakeExperiment, PartsThatDoNotGoTogether) {
  ExperimentRequest request = Brushed();
  request.noise = ParseNoise("across=2");
  EXPECT_THAT([&] { MakeExperiment(request); },
              ThrowsMessage<UsageError>(HasSubstr("give aperture, and leave source out")));
  request.noise = ParseNoise("across=2,aperture=2,source=1");
  EXPECT_THROW(MakeExperiment(request), UsageError);
  request.noise = ParseNoise("none");
  request.layout.name = "merl";
  EXPECT_THROW(MakeExperiment(request), UsageError) << "an isotropic layout of an anisotropic truth";
  request = Round();
  request.layout.name = "merl";
  request.turned = true;
  EXPECT_THAT([&] { MakeExperiment(request); },
              ThrowsMessage<UsageError>(HasSubstr("layout 'merl' has no place for a turn of the sample")));
}

}  // namespace
}  // namespace lobefit
