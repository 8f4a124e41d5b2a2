#include "lobefit/fit/objective/prediction.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/core/sel/sel_table.h"
#include "lobefit/fit/objective/kernel.h"
#include "lobefit/fit/objective/problem.h"

namespace lobefit {
namespace {

double Sine(double cosine) { return std::sqrt(std::max(0.0, 1 - cosine * cosine)); }

// Runs of samples with one incident direction share their lobes.
void PredictLobes(const SelReflectance& lobes, const Samples& samples, ThreadPool* pool,
                  std::vector<std::vector<double>>* f_r) {
  pool->Run(RunCount(samples.size()), [&](std::size_t run) {
    const std::size_t end = RunBegin(samples.size(), run + 1);
    std::vector<Vec3> wo;
    std::vector<std::vector<double>> piece;
    for (std::size_t begin = RunBegin(samples.size(), run), next = begin; begin < end; begin = next) {
      wo.clear();
      const auto same = [&] {
        return samples.wi_x[next] == samples.wi_x[begin] && samples.wi_y[next] == samples.wi_y[begin] &&
               samples.wi_z[next] == samples.wi_z[begin];
      };
      for (next = begin; next < end && same(); ++next) wo.push_back(samples.wo(next));
      lobes.Evaluate(samples.wi(begin), wo, &piece);
      for (std::size_t c = 0; c < piece.size(); ++c)
        std::copy(piece[c].begin(), piece[c].end(), (*f_r)[c].begin() + static_cast<std::ptrdiff_t>(begin));
    }
  });
}

// Adds the squared residuals of samples [begin, begin + model.size()) in one channel under every metric; each transform
// is applied once. weights[metric][sample - begin].
void AddSquares(const std::vector<std::vector<double>>& weights, const Samples& samples, std::size_t channel,
                std::size_t begin, const std::vector<double>& f_r, std::vector<SquareSum>* sums) {
  const std::size_t count = f_r.size();
  std::vector<double> model(count), target(count), residual(count);
  const double* measured = samples.values[channel].data() + begin;
  const double* cos_i = samples.wi_z.data() + begin;
  for (const Transform transform :
       {Transform::kLog1p, Transform::kCubeRoot, Transform::kLinear, Transform::kRelative}) {
    TransformMeasured(transform, f_r.data(), cos_i, count, model.data());
    TransformMeasured(transform, measured, cos_i, count, target.data());
    for (std::size_t i = 0; i < count; ++i) {
      residual[i] = model[i] - target[i];
      if (transform == Transform::kRelative) residual[i] = target[i] > 0 ? residual[i] / target[i] : std::nan("");
    }
    for (std::size_t m = 0; m < MetricChoices().size(); ++m) {
      const Metric metric = MetricChoices()[m].value;
      if (TransformOf(metric) != transform) continue;
      const double* weight = weights[m].data();
      SquareSum sum;
      for (std::size_t i = 0; i < count; ++i) {
        // What the metric has no number for: weight 0.
        const bool counts = std::isfinite(residual[i]);
        const double w = counts ? weight[i] : 0.0, r = counts ? residual[i] : 0.0;
        sum.square += w * r * r;
        sum.weight += w;
        sum.residuals += counts ? 1 : 0;
      }
      (*sums)[m].square += sum.square;
      (*sums)[m].weight += sum.weight;
      (*sums)[m].residuals += sum.residuals;
    }
  }
}

}  // namespace

double SampleWeight(Metric metric, Weighting weighting, bool own_weights, const Samples& samples, std::size_t i) {
  double weight = own_weights && !samples.weight.empty() ? samples.weight[i] : 1.0;
  if (weighting == Weighting::kSolidAngle) weight *= samples.solid_angle[i];
  if (metric == Metric::kNgan || metric == Metric::kLowLog) weight *= Sine(samples.wi_z[i]);
  if (metric == Metric::kNgan) weight *= Sine(samples.wo_z[i]);
  return weight;
}

std::vector<std::vector<double>> Predict(const Material& material, const Samples& samples, ThreadPool* pool) {
  const std::size_t channels = material.channels.size(), runs = RunCount(samples.size());
  std::vector<std::vector<double>> f_r(channels, std::vector<double>(samples.size()));
  if (material.sel) {
    PredictLobes(SelReflectance(*material.sel), samples, pool, &f_r);
    return f_r;
  }
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
      const double weight = SampleWeight(metric, weighting, own_weights, samples, i);
      sum.square += weight * residual * residual;
      sum.weight += weight;
      ++sum.residuals;
    }
  }
  return sum;
}

std::vector<MetricError> ErrorsUnderAllMetrics(Weighting weighting, const Samples& samples, const PredictPiece& predict,
                                               ThreadPool* pool) {
  const std::size_t metrics = MetricChoices().size(), runs = RunCount(samples.size());
  std::vector<std::vector<SquareSum>> sums(runs, std::vector<SquareSum>(metrics));
  pool->Run(runs, [&](std::size_t run) {
    std::vector<std::vector<double>> f_r, weights(metrics);
    constexpr std::size_t kPiece = 1024;
    const std::size_t last = RunBegin(samples.size(), run + 1);
    for (std::size_t begin = RunBegin(samples.size(), run); begin < last; begin += kPiece) {
      const std::size_t end = std::min(last, begin + kPiece);
      predict(begin, end, &f_r);
      for (std::size_t m = 0; m < metrics; ++m) {
        weights[m].resize(end - begin);
        for (std::size_t i = begin; i < end; ++i)
          weights[m][i - begin] = SampleWeight(MetricChoices()[m].value, weighting, false, samples, i);
      }
      for (std::size_t c = 0; c < f_r.size(); ++c) AddSquares(weights, samples, c, begin, f_r[c], &sums[run]);
    }
  });
  std::vector<MetricError> errors;
  for (std::size_t m = 0; m < metrics; ++m) {
    SquareSum total;
    for (std::size_t run = 0; run < runs; ++run) {
      total.square += sums[run][m].square;
      total.weight += sums[run][m].weight;
    }
    errors.push_back({MetricChoices()[m].name, std::sqrt(total.MeanSquare())});
  }
  return errors;
}

std::vector<MetricError> ErrorsUnderAllMetrics(Weighting weighting, const Samples& samples,
                                               const std::vector<std::vector<double>>& f_r, ThreadPool* pool) {
  const PredictPiece slice = [&](std::size_t begin, std::size_t end, std::vector<std::vector<double>>* piece) {
    piece->clear();
    for (const std::vector<double>& channel : f_r)
      piece->emplace_back(channel.begin() + static_cast<std::ptrdiff_t>(begin),
                          channel.begin() + static_cast<std::ptrdiff_t>(end));
  };
  return ErrorsUnderAllMetrics(weighting, samples, slice, pool);
}

}  // namespace lobefit
