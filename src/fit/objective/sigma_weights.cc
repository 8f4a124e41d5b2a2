#include "lobefit/fit/objective/sigma_weights.h"

#include <algorithm>
#include <cmath>

namespace lobefit {

SigmaWeights::SigmaWeights(const Samples& samples, Metric metric, const NoiseModel& noise)
    : samples_(samples),
      transform_(TransformOf(metric, noise)),
      noise_(RowOf(metric).curve == Curve::kAsinh ? noise : NoiseModel{}) {
  if (samples.sigma.empty() && !(noise_.poisson > 0)) return;
  if (!samples.sigma.empty()) noise_.floor = 0;
  std::vector<double> variance = Variances(samples.values, 0);
  const auto middle = variance.begin() + static_cast<std::ptrdiff_t>(variance.size() / 2);
  std::nth_element(variance.begin(), middle, variance.end());
  median_ = *middle;
  // With more than half of the samples free of uncertainty there is nothing to weigh by but the largest.
  if (!(median_ > 0)) median_ = *std::max_element(variance.begin(), variance.end());
}

std::vector<double> SigmaWeights::Variances(const std::vector<std::vector<double>>& values, std::size_t begin) const {
  // What overflows or is not a number weighs nothing.
  constexpr double kMost = 1e100;
  const std::size_t count = values[0].size();
  std::vector<double> mean(count, 0.0), variance(count);
  for (const std::vector<double>& channel : values) {
    for (std::size_t i = 0; i < count; ++i) mean[i] += channel[i] / static_cast<double>(values.size());
  }
  // Noise takes readings below zero, no surface.
  for (double& f : mean) f = std::max(f, 0.0);
  const double* cos_i = samples_.wi_z.data() + begin;
  InverseSlopes(transform_, mean.data(), cos_i, count, variance.data());
  for (std::size_t i = 0; i < count; ++i) {
    const double stated = samples_.sigma.empty() ? 0.0 : samples_.sigma[begin + i] * cos_i[i];
    const double s2 = (stated * stated + noise_.VarianceAt(mean[i] * cos_i[i])) / (variance[i] * variance[i]);
    variance[i] = s2 <= kMost ? s2 : kMost;
  }
  return variance;
}

std::vector<double> SigmaWeights::At(const std::vector<std::vector<double>>& values, std::size_t begin) const {
  std::vector<double> weight = Variances(values, begin);
  for (double& w : weight) w = 2 * median_ / (w + median_);
  return weight;
}

}  // namespace lobefit
