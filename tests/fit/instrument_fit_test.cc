// Fits with gains, a crooked sample and an offset: what they recover, what their intervals hold, what is refused.
#include <cmath>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/fit/fit.h"
#include "lobefit/measurement/prepare/pool.h"
#include "lobefit/synthesis/random.h"

namespace lobefit {
namespace {

SyntheticCase Brushed() { return OneLobe(Ndf::kEllipsoid, 0.35, 0.11, 0, 3, 25, {0.7}, {0.02}); }

GoniometerLayout Coarse(std::vector<double> azimuths_deg = {0, 60, 120}) {
  GoniometerLayout layout;
  for (const double degrees : {15., 30., 45., 60.}) layout.polar_angles.push_back(DegreesToRadians(degrees));
  for (const double degrees : azimuths_deg) layout.azimuths.push_back(DegreesToRadians(degrees));
  layout.detector_step = DegreesToRadians(15);
  return layout;
}

Measurement Measured(const SyntheticCase& truth, const GoniometerLayout& layout, const Noise& noise,
                     std::uint64_t seed) {
  const Reflectance reflectance(truth.model, truth.values, truth.channels.size());
  Measurement measurement = Synthesise(
      Goniometer(layout), {truth.channels, {}},
      [&](const Vec3& wi, const Vec3& wo, double* f_r) { reflectance.Evaluate(wi, wo, f_r); }, noise, seed);
  measurement.source = "synthetic";
  return measurement;
}

// The sample turned by half on its stage, where it stands crooked as before: a file of directions in its own frame.
Measurement Turned(Measurement measurement) {
  Samples& s = measurement.samples;
  for (std::vector<double>* array : {&s.wi_x, &s.wi_y, &s.wo_x, &s.wo_y}) {
    for (double& x : *array) x = -x;
  }
  s.sample_azimuth.assign(s.size(), kPi);
  return measurement;
}

Recipe Log(const SyntheticCase& truth) {
  Recipe recipe = DefaultRecipe(truth.model, "instrument");
  recipe.metric = Metric::kLog;
  recipe.metric_given = true;
  return recipe;
}

constexpr std::size_t kAlphaX = 0, kThetaX = 2, kThetaY = 3, kF0 = 5;

double Value(const Material& material, std::size_t i) { return material.parameters[i].values[0]; }

TEST(DriftFit, IntervalsOfSamplesTakenAsIndependentHoldUnderDrift) {
  const SyntheticCase truth = Brushed();
  Noise noise;
  noise.multiplicative = 0.05;
  noise.drift = 0.05;
  constexpr int kTrials = 60;
  int held_without = 0, held_with = 0, held_f0 = 0;
  double sum_of_squares = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Measurement a = Measured(truth, Coarse(), noise, 100 + trial), b = a;
    Recipe recipe = Log(truth);
    const Material without = CheckedFit(recipe, {}, &a);
    recipe.instrument.drift = DriftRecipe{};
    const Material with = CheckedFit(recipe, {}, &b);
    const auto holds = [&](const Material& material, std::size_t i) {
      return std::fabs(Value(material, i) - truth.values[i][0]) < 1.96 * material.parameters[i].standard_error[0];
    };
    held_without += holds(without, kF0) ? 1 : 0;
    held_with += holds(with, kThetaY) ? 1 : 0;
    held_f0 += holds(with, kF0) ? 1 : 0;
    sum_of_squares += with.instrument->drift->sd * with.instrument->drift->sd;
  }
  // 95 % of 60 are 57 +- 1.7.
  EXPECT_LT(held_without, 45);
  EXPECT_GE(held_f0, 52);
  EXPECT_GE(held_with, 52);
  EXPECT_NEAR(std::sqrt(sum_of_squares / kTrials), 0.05, 0.006);
}

// F0 is known through the gains' scatter, alpha is not: where the scatter is given in place of estimated from 12 gains,
// F0 alone has more degrees of freedom.
TEST(DriftFit, AnEstimatedScatterTakesDegreesOfFreedomFromWhatItCarries) {
  const SyntheticCase truth = Brushed();
  Noise noise;
  noise.multiplicative = 0.02;
  noise.drift = 0.05;
  const auto fit = [&](const DriftRecipe& drift) {
    Measurement measurement = Measured(truth, Coarse(), noise, 7);
    Recipe recipe = Log(truth);
    recipe.instrument.drift = drift;
    return CheckedFit(recipe, {}, &measurement);
  };
  const Material estimated = fit({}), given = fit({fit({}).instrument->drift->sd});
  const auto freedom = [](const Material& material, std::size_t i) { return material.parameters[i].freedom[0]; };
  // 1 / nu = 1 / nu_given + share^2 / 11 with a share of nearly 1.
  EXPECT_NEAR(1 / freedom(estimated, kF0) - 1 / freedom(given, kF0), 1.0 / 11, 0.02);
  EXPECT_NEAR(freedom(estimated, kAlphaX), freedom(given, kAlphaX), 0.02 * freedom(given, kAlphaX));
}

TEST(DriftFit, GainsAreThoseOfTheReadings) {
  const SyntheticCase truth = Brushed();
  Measurement measurement = Measured(truth, Coarse(), {}, 1);
  std::vector<double> gains(12);
  for (std::size_t i = 0; i < measurement.samples.size(); ++i) {
    const Vec3 wi = measurement.samples.wi(i);
    measurement.samples.values[0][i] *= wi.z > 0.8 ? 1.05 : 1 / 1.05;
  }
  Recipe recipe = Log(truth);
  recipe.instrument.drift = DriftRecipe{0.05};
  const Material material = CheckedFit(recipe, {}, &measurement);
  ASSERT_EQ(material.instrument->gains.size(), 12U);
  for (const IncidenceGain& gain : material.instrument->gains)
    EXPECT_NEAR(gain.gain / (std::cos(gain.theta_i) > 0.8 ? 1.05 : 1 / 1.05), 1, 1e-3);
  EXPECT_NEAR(Value(material, kAlphaX), 0.35, 1e-4);
}

TEST(AlignmentFit, TiltIsHeldWithACrookedSample) {
  const SyntheticCase truth = Brushed();
  constexpr int kTrials = 40;
  int held = 0, held_without = 0, told = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomNumbers random(700 + trial);
    Noise noise;
    noise.multiplicative = 0.03;
    noise.misalignment_x = 0.2 * random.Normal() * kPi / 180;
    noise.misalignment_y = 0.2 * random.Normal() * kPi / 180;
    Measurement a = Measured(truth, Coarse({0}), noise, 300 + trial), b = a;
    Recipe recipe = Log(truth);
    const Material without = CheckedFit(recipe, {}, &a);
    recipe.instrument.alignment = AlignmentRecipe();
    const Material with = CheckedFit(recipe, {}, &b);
    for (const std::size_t i : {kThetaX, kThetaY}) {
      const auto holds = [&](const Material& material) {
        return std::fabs(Value(material, i) - truth.values[i][0]) < 1.96 * material.parameters[i].standard_error[0];
      };
      held += holds(with) ? 1 : 0;
      held_without += holds(without) ? 1 : 0;
    }
    told += *with.instrument->told_from_tilt ? 1 : 0;
  }
  // 95 % of 80 are 76 +- 1.9.
  EXPECT_GE(held, 70);
  EXPECT_LT(held_without, 40);
  EXPECT_EQ(told, 0);
}

TEST(AlignmentFit, TurningTheSampleTellsItFromTheTilt) {
  const SyntheticCase truth = Brushed();
  Noise noise;
  noise.multiplicative = 0.01;
  noise.misalignment_x = 0.3 * kPi / 180;
  noise.misalignment_y = -0.2 * kPi / 180;
  const Measurement first = Measured(truth, Coarse({0}), noise, 1);
  // On its stage the turned sample shows its other side: the truth in the frame of the stage is turned too.
  SyntheticCase turned = truth;
  turned.values[2][0] = -truth.values[2][0];
  turned.values[3][0] = -truth.values[3][0];
  const Measurement second = Turned(Measured(turned, Coarse({0}), noise, 2));
  Measurement both = Pool({first, second}, false);
  Recipe recipe = Log(truth);
  recipe.instrument.alignment = AlignmentRecipe();
  const Material material = CheckedFit(recipe, {}, &both);
  ASSERT_EQ(material.instrument->alignment.size(), 3U);
  EXPECT_TRUE(*material.instrument->told_from_tilt);
  const double degree = kPi / 180;
  EXPECT_NEAR(Value(material, kThetaY) / degree, 3, 0.1);
  EXPECT_NEAR(material.instrument->alignment[0].value / degree, 0.3, 0.05);
  EXPECT_NEAR(material.instrument->alignment[1].value / degree, -0.2, 0.1);
}

TEST(OffsetFit, IsFoundWhereIncidencesDiffer) {
  const SyntheticCase truth = Brushed();
  Measurement measurement = Measured(truth, Coarse(), {}, 1);
  for (std::size_t i = 0; i < measurement.samples.size(); ++i)
    measurement.samples.values[0][i] += 0.01 / measurement.samples.wi_z[i];
  Recipe recipe = Log(truth);
  recipe.instrument.offset = true;
  const Material material = CheckedFit(recipe, {}, &measurement);
  EXPECT_NEAR(material.instrument->offset[0].value, 0.01, 1e-6);
  EXPECT_NEAR(Value(material, kAlphaX), 0.35, 1e-5);
}

// A file's own words do what the recipe's do, which come first.
TEST(InstrumentFit, IsWhatTheFileStates) {
  const SyntheticCase truth = Brushed();
  Noise noise;
  noise.multiplicative = 0.03;
  noise.drift = 0.05;
  Measurement plain = Measured(truth, Coarse(), noise, 4), stating = plain, both = plain;
  Recipe recipe = Log(truth), asked = recipe;
  asked.instrument.drift = DriftRecipe{0.05};
  asked.instrument.alignment = AlignmentRecipe();
  stating.instrument.drift = StatedDrift{0.05};
  stating.instrument.alignment = AlignmentRecipe().prior;
  both.instrument.drift = StatedDrift{};
  both.instrument.alignment = DegreesToRadians(3);
  const Material by_recipe = CheckedFit(asked, {}, &plain), by_file = CheckedFit(recipe, {}, &stating),
                 by_both = CheckedFit(asked, {}, &both);
  ASSERT_TRUE(by_file.instrument && by_file.instrument->drift);
  EXPECT_FALSE(by_file.instrument->drift->estimated);
  EXPECT_EQ(by_file.instrument->alignment.size(), by_recipe.instrument->alignment.size());
  for (std::size_t i = 0; i < by_recipe.parameters.size(); ++i) {
    EXPECT_EQ(Value(by_file, i), Value(by_recipe, i)) << i;
    EXPECT_EQ(Value(by_both, i), Value(by_recipe, i)) << i;
  }
  // An offset, and the noise that gives asinh its knee.
  noise.drift = 0;
  noise.additive = 0.002;
  Measurement straddling = Measured(truth, Coarse(), noise, 5);
  straddling.instrument.offset = true;
  straddling.instrument.noise = StatedNoise{0.002, 0.03, 0};
  recipe.metric = Metric::kCubeRoot;
  recipe.metric_given = false;
  const Material with_noise = CheckedFit(recipe, {}, &straddling);
  EXPECT_EQ(with_noise.metric, "asinh");
  EXPECT_EQ(with_noise.instrument->offset.size(), 1U);
}

TEST(InstrumentFit, SaysWhyItRefuses) {
  const SyntheticCase truth = Brushed();
  GoniometerLayout one = Coarse({0});
  one.polar_angles = {DegreesToRadians(45)};
  const auto message = [&](const GoniometerLayout& layout, const auto& set) -> std::string {
    Measurement measurement = Measured(truth, layout, {}, 1);
    Recipe recipe = Log(truth);
    set(&recipe.instrument);
    try {
      CheckedFit(recipe, {}, &measurement);
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(message(one, [](InstrumentRecipe* r) { r->alignment = AlignmentRecipe(); }),
              testing::HasSubstr("cannot be told from one incident direction"));
  EXPECT_THAT(message(one, [](InstrumentRecipe* r) { r->drift = DriftRecipe{}; }),
              testing::HasSubstr("three are needed"));
  EXPECT_THAT(message(one, [](InstrumentRecipe* r) { r->offset = true; }),
              testing::HasSubstr("exactly a diffuse part"));
}

}  // namespace
}  // namespace lobefit
