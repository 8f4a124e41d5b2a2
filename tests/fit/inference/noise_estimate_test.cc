#include "lobefit/fit/inference/noise_estimate.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/fit/fit.h"

namespace lobefit {
namespace {

Measurement Noisy(const NoiseModel& noise, std::uint64_t seed, double step_deg,
                  std::vector<std::vector<double>>* truth) {
  GoniometerLayout layout = StandardLayout();
  layout.azimuths = {0};
  layout.detector_step = DegreesToRadians(step_deg);
  const SyntheticCase material = OneLobe(Ndf::kGgx, 0.25, 0.25, 0, 0, 0, {0.5}, {0.1});
  Measurement measurement = Synthetic(material, layout, 0, seed);
  *truth = measurement.samples.values;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  for (std::size_t i = 0; i < measurement.samples.size(); ++i) {
    const double v = (*truth)[0][i] * measurement.samples.wi_z[i];
    measurement.samples.values[0][i] += std::sqrt(noise.VarianceAt(v)) * normal(random) / measurement.samples.wi_z[i];
  }
  return measurement;
}

TEST(EstimateNoise, FindsFloorAndRelativeNoiseAgainWhateverTheGainOfAnIncidence) {
  for (const NoiseModel noise : {NoiseModel{0.02, 0.05}, {0.05, 0.02}, {0.002, 0.05}}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      std::vector<std::vector<double>> truth;
      Measurement measurement = Noisy(noise, seed, 8, &truth);
      const Incidences incidences = GroupByIncidence(measurement);
      // 5 % of gain more in every second incidence, which the model does not have.
      for (std::size_t i = 0; i < measurement.samples.size(); ++i)
        if (incidences.group[i] % 2 == 0) measurement.samples.values[0][i] += 0.02 * truth[0][i];
      const std::optional<NoiseModel> found = EstimateNoise(measurement.samples, incidences, truth);
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->floor / noise.floor, 1, noise.floor < 0.01 ? 0.5 : 0.2) << noise.floor << " " << seed;
      if (noise.relative > 0.02) {
        EXPECT_NEAR(found->relative / noise.relative, 1, 0.3) << noise.floor << " " << seed;
      }
    }
  }
}

TEST(EstimateNoise, FindsCountingNoiseWhereThereIsAndNoneWhereNot) {
  int false_alarms = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const NoiseModel noise : {NoiseModel{0, 0, 0.001}, {0.001, 0.02, 0.002}}) {
      std::vector<std::vector<double>> truth;
      const Measurement measurement = Noisy(noise, seed, 5, &truth);
      const std::optional<NoiseModel> found = EstimateNoise(measurement.samples, GroupByIncidence(measurement), truth);
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->poisson / noise.poisson, 1, 0.35) << seed << " " << noise.floor;
      // As a function of the value it is the noise, whichever term has it.
      for (const double v : {0.02, 0.1, 0.5})
        EXPECT_NEAR(std::sqrt(found->VarianceAt(v) / noise.VarianceAt(v)), 1, 0.2) << seed << " " << v;
    }
    std::vector<std::vector<double>> truth;
    const Measurement measurement = Noisy({0.004, 0.05}, seed, 5, &truth);
    const std::optional<NoiseModel> found = EstimateNoise(measurement.samples, GroupByIncidence(measurement), truth);
    ASSERT_TRUE(found);
    false_alarms += found->poisson > 0 ? 1 : 0;
  }
  EXPECT_LE(false_alarms, 1);
}

// A model that is off by 20 % from one direction to the next looks like noise to neighbours, not to repeated readings;
// rows that are only copied tell nothing.
TEST(EstimateNoise, RepeatedReadingsTellItFromMisfit) {
  const NoiseModel noise = {0.005, 0.03};
  std::vector<std::vector<double>> truth, again;
  Measurement once = Noisy(noise, 1, 15, &truth);
  const Measurement twice = Noisy(noise, 2, 15, &again);
  const std::size_t count = once.samples.size();
  const auto with = [&](const Samples& other) {
    Measurement both = once;
    for (std::size_t i = 0; i < count; ++i) {
      const double f = other.values[0][i];
      both.samples.Append(other.wi(i), other.wo(i), &f, 0);
    }
    return both;
  };
  std::vector<std::vector<double>> rough(1);
  for (std::size_t i = 0; i < 2 * count; ++i)
    rough[0].push_back(truth[0][i % count] * (1 + 0.2 * std::sin(137.0 * static_cast<double>(i % count))));
  const auto estimate = [&](const Measurement& measurement) {
    return EstimateNoise(measurement.samples, GroupByIncidence(measurement), rough).value();
  };
  const NoiseModel repeated = estimate(with(twice.samples)), copied = estimate(with(once.samples));
  EXPECT_NEAR(repeated.floor, 0.005, 0.001);
  EXPECT_NEAR(repeated.relative, 0.03, 0.007);
  EXPECT_GT(copied.relative, 0.08);
}

TEST(EstimateNoise, ExactValuesAndFewSamplesHaveNone) {
  std::vector<std::vector<double>> truth;
  const Measurement exact = Noisy({0, 0}, 1, 15, &truth);
  EXPECT_FALSE(EstimateNoise(exact.samples, GroupByIncidence(exact), truth));
  Measurement few = Noisy({0.02, 0.05}, 1, 15, &truth);
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < 30; ++i) some.push_back(i);
  few.samples = few.samples.Subset(some);
  truth[0].resize(30);
  EXPECT_FALSE(EstimateNoise(few.samples, GroupByIncidence(few), truth));
}

// Readings about zero: the default metric would take the diffuse part for noise.
TEST(Fit, TurnsToAsinhWhereNoiseReachesZeroAndSaysSo) {
  std::vector<std::vector<double>> truth;
  const Measurement noisy = Noisy({0.05, 0.01}, 3, 8, &truth);
  const Recipe recipe = DefaultRecipe({{Lobe{Ndf::kGgx}}, Diffuse::kLambert}, "test");
  Measurement measurement = noisy;
  const Material material = CheckedFit(recipe, {}, &measurement);
  EXPECT_EQ(material.metric, "asinh");
  ASSERT_FALSE(material.remarks.empty());
  EXPECT_NE(material.remarks[0].find("of the readings are negative"), std::string::npos) << material.remarks[0];
  EXPECT_NE(material.remarks[0].find("--metric cube-root keeps it"), std::string::npos) << material.remarks[0];
  EXPECT_NEAR(material.parameters[0].values[0], 0.25, 4 * material.parameters[0].standard_error[0]);
  EXPECT_NEAR(material.parameters[5].values[0], 0.5, 4 * material.parameters[5].standard_error[0]);
  EXPECT_NEAR(material.parameters[6].values[0], 0.1, 4 * material.parameters[6].standard_error[0]);
  // Where the user chose, the choice stands, with a warning.
  Recipe given = recipe;
  given.metric_given = true;
  measurement = noisy;
  const Material kept = CheckedFit(given, {}, &measurement);
  EXPECT_EQ(kept.metric, "cube-root");
  ASSERT_FALSE(kept.remarks.empty());
  EXPECT_NE(kept.remarks[0].find("is biased by the noise"), std::string::npos) << kept.remarks[0];
  // asinh by name takes its knee from the data too.
  given.metric = Metric::kAsinh;
  measurement = noisy;
  EXPECT_EQ(CheckedFit(given, {}, &measurement).parameters[0].values, material.parameters[0].values);
}

TEST(Fit, SaysThatAnotherMetricDoesNotTakeTheNoise) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.3, 0.3, 0, 0, 0, {0.6}, {0.1});
  Recipe recipe = DefaultRecipe(truth.model, "test");
  recipe.noise = {0.002, 0.05};
  const auto says = [&] {
    Measurement measurement = Synthetic(truth, StandardLayout(), 0.05, 1);
    const Material material = CheckedFit(recipe, {}, &measurement);
    return std::any_of(material.remarks.begin(), material.remarks.end(), [](const std::string& remark) {
      return remark.find("weighs nothing under metric log") != std::string::npos;
    });
  };
  EXPECT_FALSE(says()) << "asinh is then chosen";
  recipe.metric = Metric::kLog;
  recipe.metric_given = true;
  EXPECT_TRUE(says());
}

// A first fit that the noise has bent leaves residuals of 12 % of the value: the knee is not taken from those.
TEST(Fit, TakesTheKneeFromAFitThatTheNoiseHasNotBent) {
  GoniometerLayout layout = StandardLayout();
  layout.polar_angles = {0.35, 0.7, 1.05};
  const SyntheticCase metal = OneLobe(Ndf::kEllipsoid, 0.35, 0.11, 0, 3, 25, {0.7}, {0.02});
  Measurement measurement = Synthetic(metal, layout, 0, 1);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0, 0.05);
  for (std::size_t i = 0; i < measurement.samples.size(); ++i)
    measurement.samples.values[0][i] += normal(random) / measurement.samples.wi_z[i];
  const Material material = CheckedFit(DefaultRecipe(metal.model, "test"), {}, &measurement);
  EXPECT_EQ(material.metric, "asinh");
  ASSERT_FALSE(material.remarks.empty());
  EXPECT_NE(material.remarks[0].find("noise below 2 % of the value"), std::string::npos) << material.remarks[0];
  EXPECT_NE(material.remarks[0].find("noise floor 0.05"), std::string::npos) << material.remarks[0];
}

TEST(Fit, KeepsTheDefaultMetricUnderNoiseProportionalToTheValue) {
  std::vector<std::vector<double>> truth;
  // Also of so many samples that the bias of rho^2 / 3 is several standard errors.
  for (const double step : {8.0, 2.5}) {
    Measurement measurement = Noisy({0, 0.05}, 3, step, &truth);
    const Recipe recipe = DefaultRecipe({{Lobe{Ndf::kGgx}}, Diffuse::kLambert}, "test");
    const Material material = CheckedFit(recipe, {}, &measurement);
    EXPECT_EQ(material.metric, "cube-root") << measurement.samples.size();
    EXPECT_TRUE(material.remarks.empty());
  }
}

// Stated uncertainties weigh at the model's value: at the reading they favour what fell low, by several standard errors
// here.
TEST(Fit, StatedUncertaintiesDoNotBias) {
  double f0 = 0, error = 0;
  constexpr int kTrials = 12;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<std::vector<double>> truth;
    Measurement measurement = Noisy({0, 0.2}, 100 + static_cast<std::uint64_t>(trial), 8, &truth);
    for (const double f : truth[0]) measurement.samples.sigma.push_back(0.2 * f);
    Recipe recipe = DefaultRecipe({{Lobe{Ndf::kGgx}}, Diffuse::kLambert}, "test");
    recipe.metric = Metric::kCosineL2;
    const Material material = CheckedFit(recipe, {}, &measurement);
    f0 += material.parameters[5].values[0] / kTrials;
    error += material.parameters[5].standard_error[0] / kTrials;
  }
  EXPECT_NEAR(f0, 0.5, 3.5 * error / std::sqrt(static_cast<double>(kTrials)));
}

}  // namespace
}  // namespace lobefit
