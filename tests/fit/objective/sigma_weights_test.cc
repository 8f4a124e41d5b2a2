#include "lobefit/fit/objective/sigma_weights.h"

#include <cmath>

#include <gtest/gtest.h>

namespace lobefit {
namespace {

Samples Readings(const std::vector<double>& values, const std::vector<double>& sigma, double cos_i) {
  Samples samples;
  samples.values.resize(1);
  for (const double value : values) samples.Append({std::sqrt(1 - cos_i * cos_i), 0, cos_i}, {0, 0, 1}, &value, 0);
  samples.sigma = sigma;
  return samples;
}

// Inverse variance of the residual, tempered by the median one. Catches the weights of another metric, those at the
// reading and those without its slope.
TEST(SigmaWeights, AreThoseOfTheMetricAtTheModelsValue) {
  const Samples samples = Readings({0.2, 1.0, 4.0}, {0.01, 0.02, 0.3}, 0.5);
  const std::vector<std::vector<double>> model = {{0.3, 0.9, 5.0}};
  const auto slope = [](Metric metric, double v) {
    if (metric == Metric::kLog) return 1 / (1 + v);
    if (metric == Metric::kCubeRoot) return 1 / (3 * std::pow(v, 2.0 / 3));
    return metric == Metric::kRelative ? 1 / v : 1.0;
  };
  for (const Metric metric : {Metric::kLog, Metric::kCubeRoot, Metric::kRelative, Metric::kCosineL2}) {
    std::vector<double> readings, at_model;
    for (std::size_t i = 0; i < 3; ++i) {
      const double s = samples.sigma[i] * 0.5;
      readings.push_back(std::pow(slope(metric, samples.values[0][i] * 0.5) * s, 2));
      at_model.push_back(std::pow(slope(metric, model[0][i] * 0.5) * s, 2));
    }
    std::sort(readings.begin(), readings.end());
    const SigmaWeights weights(samples, metric, {});
    const std::vector<double> found = weights.At(model, 0);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(found[i], 2 * readings[1] / (at_model[i] + readings[1]), 1e-13) << static_cast<int>(metric);
  }
}

TEST(SigmaWeights, OfAsinhAreEvenForItsOwnNoise) {
  const NoiseModel noise = {0.01, 0.1};
  const Samples samples = Readings({-0.01, 0.0, 0.2, 5.0}, std::vector<double>(4, noise.floor / 0.5), 0.5);
  for (const double weight : SigmaWeights(samples, Metric::kAsinh, noise).AtReadings()) EXPECT_NEAR(weight, 1, 1e-12);
}

TEST(SigmaWeights, NegativeReadingsAndUnstatedUncertainty) {
  EXPECT_TRUE(SigmaWeights(Readings({1, 2}, {}, 1), Metric::kCubeRoot, {}).empty());
  EXPECT_TRUE(SigmaWeights(Readings({1, 2}, {0, 0}, 1), Metric::kCubeRoot, {}).empty());
  const Samples samples = Readings({-0.5, 1, 2}, {0.1, 0.1, 0.1}, 1);
  const SigmaWeights weights(samples, Metric::kLog, {});
  for (const double weight : weights.AtReadings()) EXPECT_TRUE(weight > 0 && weight < 2);
}

}  // namespace
}  // namespace lobefit
