#include "lobefit/fit/metric/metric.h"

#include <algorithm>
#include <cmath>

namespace lobefit {
namespace {

double Sine(double cosine) { return std::sqrt(std::max(0.0, 1 - cosine * cosine)); }

}  // namespace

const std::vector<MetricRow>& MetricTable() {
  static const std::vector<MetricRow> table = {
      {Metric::kLog, "log", "ln(1 + f cos_theta_i), differences", Curve::kLogOnePlus, false, false},
      {Metric::kCubeRoot, "cube-root", "cube root of f cos_theta_i, differences", Curve::kCubeRoot, false, false},
      {Metric::kRelative, "relative", "relative differences of f", Curve::kRelative, false, false},
      {Metric::kCosineL2, "cosine-l2", "differences of f cos_theta_i", Curve::kLinear, false, false},
      {Metric::kNgan, "ngan", "differences of f cos_theta_i, weighted by sin_theta_i sin_theta_o", Curve::kLinear, true,
       true},
      {Metric::kLowLog, "low-log", "ln(1 + f cos_theta_i), differences weighted by sin_theta_i", Curve::kLogOnePlus,
       true, false},
      {Metric::kAsinh, "asinh", "asinh of f cos_theta_i over a knee at the noise, differences; for values about zero",
       Curve::kAsinh, false, false},
  };
  return table;
}

const MetricRow& RowOf(Metric metric) { return MetricTable()[static_cast<std::size_t>(metric)]; }

const std::vector<Choice<Metric>>& MetricChoices() {
  static const std::vector<Choice<Metric>> choices = [] {
    std::vector<Choice<Metric>> rows;
    for (const MetricRow& row : MetricTable()) rows.push_back({row.metric, row.name, row.description});
    return rows;
  }();
  return choices;
}

Transform TransformOf(Metric metric, const NoiseModel& noise) {
  Transform transform = {RowOf(metric).curve};
  if (transform.curve == Curve::kAsinh) {
    transform.knee = noise.floor / noise.relative;
    transform.mean_shift = 0.5 * noise.relative * noise.relative;
    if (!(noise.poisson > 0)) return transform;
    // Where the part of the value is known to be small the curve need not be logarithmic so soon.
    constexpr double kLeastRelative = 0.02, kLeastCounts = 30;
    transform.knee = std::max(noise.floor / std::max(noise.relative, kLeastRelative), kLeastCounts * noise.poisson);
    const double at_knee = noise.relative * transform.knee;
    transform.floor_shift = 0.5 * (noise.floor * noise.floor - at_knee * at_knee);
    transform.poisson_shift = 0.5 * noise.poisson;
  }
  return transform;
}

double AngularWeight(Metric metric, double cos_theta_i, double cos_theta_o) {
  const MetricRow& row = RowOf(metric);
  return (row.sin_i ? Sine(cos_theta_i) : 1.0) * (row.sin_o ? Sine(cos_theta_o) : 1.0);
}

}  // namespace lobefit
