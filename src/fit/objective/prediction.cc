#include "lobefit/fit/objective/prediction.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/core/sel/sel_table.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/objective/reading.h"
#include "lobefit/fit/objective/sigma_weights.h"

namespace lobefit {
namespace {

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

// Weighted squares of residuals. What the metric has no number for does not count.
SquareSum SumOf(const std::vector<double>& residual, const double* weight) {
  SquareSum sum;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    const bool counts = std::isfinite(residual[i]);
    const double w = counts ? weight[i] : 0.0, r = counts ? residual[i] : 0.0;
    sum.square += w * r * r;
    sum.weight += w;
    sum.residuals += counts ? 1 : 0;
  }
  return sum;
}

void Add(const SquareSum& more, SquareSum* sum) {
  sum->square += more.square;
  sum->weight += more.weight;
  sum->residuals += more.residuals;
}

// Residuals of a channel, NaN where the curve has no number for the measured value.
void ResidualsOf(const Transform& transform, const Samples& samples, std::size_t channel, std::size_t begin,
                 const std::vector<double>& f_r, std::vector<double>* residual) {
  const double* measured = samples.values[channel].data() + begin;
  const double* cos_i = samples.wi_z.data() + begin;
  residual->resize(f_r.size());
  Residuals(transform, f_r.data(), cos_i, measured, nullptr, f_r.size(), residual->data(), nullptr);
  for (std::size_t i = 0; i < f_r.size(); ++i) {
    if (!Takes(transform, measured[i], cos_i[i])) (*residual)[i] = std::nan("");
  }
}

// Metrics that can be evaluated, in the order of the table.
std::vector<Metric> KnownMetrics(const NoiseModel& noise) {
  std::vector<Metric> metrics;
  for (const MetricRow& row : MetricTable()) {
    const bool known = row.curve != Curve::kAsinh || noise.IsKnown();
    if (known) metrics.push_back(row.metric);
  }
  return metrics;
}

// Adds the squared residuals of samples [begin, begin + f_r.size()) in one channel under every metric; each curve is
// evaluated once. weights[metric][sample - begin].
void AddSquares(const std::vector<Metric>& metrics, const NoiseModel& noise,
                const std::vector<std::vector<double>>& weights, const Samples& samples, std::size_t channel,
                std::size_t begin, const std::vector<double>& f_r, std::vector<SquareSum>* sums) {
  std::vector<double> residual;
  for (std::size_t first = 0; first < metrics.size(); ++first) {
    const Curve curve = RowOf(metrics[first]).curve;
    const auto same = [&](Metric metric) { return RowOf(metric).curve == curve; };
    if (std::any_of(metrics.begin(), metrics.begin() + static_cast<std::ptrdiff_t>(first), same)) continue;
    ResidualsOf(TransformOf(metrics[first], noise), samples, channel, begin, f_r, &residual);
    for (std::size_t m = first; m < metrics.size(); ++m) {
      if (same(metrics[m])) Add(SumOf(residual, weights[m].data()), &(*sums)[m]);
    }
  }
}

}  // namespace

double SampleWeight(Metric metric, Weighting weighting, bool own_weights, const Samples& samples, std::size_t i) {
  double weight = own_weights && !samples.weight.empty() ? samples.weight[i] : 1.0;
  if (weighting == Weighting::kSolidAngle) weight *= samples.solid_angle[i];
  weight *= AngularWeight(metric, samples.wi_z[i], samples.wo_z[i]);
  return weight;
}

std::vector<std::vector<double>> Predict(const Material& material, const Samples& samples, ThreadPool* pool) {
  const std::size_t channels = material.channels.size(), runs = RunCount(samples.size());
  std::vector<std::vector<double>> f_r(channels, std::vector<double>(samples.size()));
  if (material.sel) {
    PredictLobes(SelReflectance(*material.sel), samples, pool, &f_r);
    return f_r;
  }
  const std::optional<Reading> reading =
      material.instrument ? std::make_optional<Reading>(material, std::nullopt) : std::nullopt;
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
    if (reading) {
      reading->Evaluate(directions, samples.sample_azimuth.empty() ? nullptr : samples.sample_azimuth.data() + begin,
                        &piece);
    } else {
      reflectance.Evaluate(directions, &piece);
    }
    for (std::size_t c = 0; c < channels; ++c)
      std::copy(piece[c].begin(), piece[c].end(), f_r[c].begin() + static_cast<std::ptrdiff_t>(begin));
  });
  return f_r;
}

SquareSum SumSquares(Metric metric, const NoiseModel& noise, Weighting weighting, bool own_weights,
                     const Samples& samples, const std::vector<std::vector<double>>& f_r) {
  std::vector<double> weight(samples.size()), residual;
  for (std::size_t i = 0; i < samples.size(); ++i) weight[i] = SampleWeight(metric, weighting, own_weights, samples, i);
  if (const SigmaWeights sigma(samples, metric, noise); own_weights && !sigma.empty()) {
    const std::vector<double> stated = sigma.AtReadings();
    for (std::size_t i = 0; i < samples.size(); ++i) weight[i] *= stated[i];
  }
  SquareSum sum;
  for (std::size_t c = 0; c < f_r.size(); ++c) {
    ResidualsOf(TransformOf(metric, noise), samples, c, 0, f_r[c], &residual);
    Add(SumOf(residual, weight.data()), &sum);
  }
  return sum;
}

std::vector<MetricError> ErrorsUnderAllMetrics(const NoiseModel& noise, Weighting weighting, const Samples& samples,
                                               const PredictPiece& predict, ThreadPool* pool) {
  const std::vector<Metric> metrics = KnownMetrics(noise);
  const std::size_t runs = RunCount(samples.size());
  std::vector<std::vector<SquareSum>> sums(runs, std::vector<SquareSum>(metrics.size()));
  pool->Run(runs, [&](std::size_t run) {
    std::vector<std::vector<double>> f_r, weights(metrics.size());
    constexpr std::size_t kPiece = 1024;
    const std::size_t last = RunBegin(samples.size(), run + 1);
    for (std::size_t begin = RunBegin(samples.size(), run); begin < last; begin += kPiece) {
      const std::size_t end = std::min(last, begin + kPiece);
      predict(begin, end, &f_r);
      for (std::size_t m = 0; m < metrics.size(); ++m) {
        weights[m].resize(end - begin);
        for (std::size_t i = begin; i < end; ++i)
          weights[m][i - begin] = SampleWeight(metrics[m], weighting, false, samples, i);
      }
      for (std::size_t c = 0; c < f_r.size(); ++c)
        AddSquares(metrics, noise, weights, samples, c, begin, f_r[c], &sums[run]);
    }
  });
  std::vector<MetricError> errors;
  for (std::size_t m = 0; m < metrics.size(); ++m) {
    SquareSum total;
    for (std::size_t run = 0; run < runs; ++run) Add(sums[run][m], &total);
    errors.push_back({RowOf(metrics[m]).name, std::sqrt(total.MeanSquare())});
  }
  return errors;
}

std::vector<MetricError> ErrorsUnderAllMetrics(const NoiseModel& noise, Weighting weighting, const Samples& samples,
                                               const std::vector<std::vector<double>>& f_r, ThreadPool* pool) {
  const PredictPiece slice = [&](std::size_t begin, std::size_t end, std::vector<std::vector<double>>* piece) {
    piece->clear();
    for (const std::vector<double>& channel : f_r)
      piece->emplace_back(channel.begin() + static_cast<std::ptrdiff_t>(begin),
                          channel.begin() + static_cast<std::ptrdiff_t>(end));
  };
  return ErrorsUnderAllMetrics(noise, weighting, samples, slice, pool);
}

}  // namespace lobefit
