#include "lobefit/fit/prediction.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/reflectance.h"
#include "lobefit/fit/kernel.h"
#include "lobefit/fit/problem.h"

namespace lobefit {
namespace {

double Sine(double cosine) { return std::sqrt(std::max(0.0, 1 - cosine * cosine)); }

double Weight(Metric metric, Weighting weighting, bool own_weights, const Samples& samples, std::size_t i) {
  double weight = own_weights && !samples.weight.empty() ? samples.weight[i] : 1.0;
  if (weighting == Weighting::kSolidAngle) weight *= samples.solid_angle[i];
  if (metric == Metric::kNgan || metric == Metric::kLowLog) weight *= Sine(samples.wi_z[i]);
  if (metric == Metric::kNgan) weight *= Sine(samples.wo_z[i]);
  return weight;
}

}  // namespace

std::vector<std::vector<double>> Predict(const Material& material, const Samples& samples, ThreadPool* pool) {
  const std::size_t channels = material.channels.size(), runs = RunCount(samples.size());
  std::vector<std::vector<double>> f_r(channels, std::vector<double>(samples.size()));
  const Reflectance reflectance(material.model, material.Values(), channels);
  pool->Run(runs, [&](std::size_t run) {
    const std::size_t begin = RunBegin(samples.size(), run), end = RunBegin(samples.size(), run + 1);
    const DirectionArrays directions = {samples.wi_x.data() + begin,
                                        samples.wi_y.data() + begin,
                                        samples.wi_z.data() + begin,
                                        samples.wo_x.data() + begin,
                                        samples.wo_y.data() + begin,
                                        samples.wo_z.data() + begin,
                                        end - begin};
    std::vector<std::vector<double>> piece;
    reflectance.Evaluate(directions, &piece);
    for (std::size_t c = 0; c < channels; ++c)
      std::copy(piece[c].begin(), piece[c].end(), f_r[c].begin() + static_cast<std::ptrdiff_t>(begin));
  });
  return f_r;
}

SquareSum SumSquares(Metric metric, Weighting weighting, bool own_weights, const Samples& samples,
                     const std::vector<std::vector<double>>& f_r) {
  const Transform transform = TransformOf(metric);
  const std::size_t count = samples.size();
  std::vector<double> model(count), target(count);
  SquareSum sum;
  for (std::size_t c = 0; c < f_r.size(); ++c) {
    TransformMeasured(transform, f_r[c].data(), samples.wi_z.data(), count, model.data());
    TransformMeasured(transform, samples.values[c].data(), samples.wi_z.data(), count, target.data());
    for (std::size_t i = 0; i < count; ++i) {
      double residual = model[i] - target[i];
      if (transform == Transform::kRelative) residual = target[i] > 0 ? residual / target[i] : std::nan("");
      if (!std::isfinite(residual)) continue;
      const double weight = Weight(metric, weighting, own_weights, samples, i);
      sum.square += weight * residual * residual;
      sum.weight += weight;
      ++sum.residuals;
    }
  }
  return sum;
}

std::vector<MetricError> ErrorsUnderAllMetrics(Weighting weighting, const Samples& samples,
                                               const std::vector<std::vector<double>>& f_r) {
  std::vector<MetricError> errors;
  for (const Choice<Metric>& metric : MetricChoices()) {
    errors.push_back({metric.name, std::sqrt(SumSquares(metric.value, weighting, false, samples, f_r).MeanSquare())});
  }
  return errors;
}

}  // namespace lobefit
