#include "lobefit/fit/inference/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/fit/inference/noise_estimate.h"
#include "lobefit/math/statistics.h"

namespace lobefit {
namespace {

constexpr double kOfNormal = 0.6744897501960817;  // median of |x| of a normal distribution, in standard deviations
constexpr std::size_t kRun = 64, kMostRuns = 3200;
constexpr double kWithinNoise = 1.2, kClose = 0.1, kRough = 0.4, kMostNoise = 0.1, kNotNoise = 0.3,
                 kLeastExplained = 0.1, kFloors = 3;

std::optional<NoiseModel> NoiseOf(const Layout& layout, const KernelModel& kernel, const Samples& samples,
                                  const Incidences& incidences) {
  const NoiseSubset subset = SubsetForNoise(samples, incidences);
  if (subset.samples.size() == 0) return std::nullopt;
  const Problem problem(subset.samples, layout.recipe());
  std::vector<std::vector<double>> f_r;
  ModelValues(problem.kernel_samples(), kernel, 0, problem.size(), &f_r);
  return EstimateNoise(subset.samples, subset.incidences, f_r);
}

double MedianOrNan(std::vector<double> values) { return values.empty() ? kNan : Median(std::move(values)); }

}  // namespace

Verdict JudgeFit(const Problem& problem, const Layout& layout, const std::vector<double>& u, const Samples& samples,
                 const Incidences& incidences, double explained, bool structured, ThreadPool* pool) {
  const KernelModel kernel = layout.ToKernel(u.data());
  std::optional<NoiseModel> noise = NoiseOf(layout, kernel, samples, incidences);
  if (noise && !(noise->relative <= kNotNoise)) noise.reset();
  const NoiseModel dark = noise.value_or(NoiseModel{});
  const std::size_t step = std::max<std::size_t>(1, samples.size() / kRun / kMostRuns) * kRun;
  const std::size_t runs = (samples.size() + step - 1) / step;
  std::vector<std::vector<double>> errors(runs), deviations(runs);
  pool->Run(runs, [&](std::size_t r) {
    const std::size_t begin = r * step, end = std::min(samples.size(), begin + kRun);
    std::vector<std::vector<double>> predicted;
    ModelValues(problem.kernel_samples(), kernel, begin, end, &predicted);
    for (std::size_t c = 0; c < predicted.size(); ++c) {
      for (std::size_t i = begin; i < end; ++i) {
        const double m = samples.values[c][i], f = predicted[c][i - begin], v = m * samples.wi_z[i];
        if (!(v > kFloors * std::sqrt(dark.DarkVarianceAt(v)))) continue;
        errors[r].push_back(f > 0 ? std::fabs(std::log(f / m)) : std::numeric_limits<double>::max());
        if (noise) deviations[r].push_back(std::sqrt(noise->VarianceAt(v)) / v);
      }
    }
  });
  std::vector<double> all_errors, all_deviations;
  for (std::size_t r = 0; r < runs; ++r) {
    all_errors.insert(all_errors.end(), errors[r].begin(), errors[r].end());
    all_deviations.insert(all_deviations.end(), deviations[r].begin(), deviations[r].end());
  }
  Verdict verdict;
  verdict.typical_error = MedianOrNan(std::move(all_errors));
  verdict.noise = MedianOrNan(std::move(all_deviations));
  verdict.explained = explained;
  const double error = verdict.typical_error;
  if (!(error <= kRough) || explained < kLeastExplained) {
    verdict.kind = VerdictKind::kDoesNotDescribe;
  } else if (error <= kWithinNoise * kOfNormal * verdict.noise && (verdict.noise <= kMostNoise || !structured)) {
    verdict.kind = VerdictKind::kWithinNoise;
  } else {
    verdict.kind = error <= kClose ? VerdictKind::kClose : VerdictKind::kRough;
  }
  return verdict;
}

}  // namespace lobefit
