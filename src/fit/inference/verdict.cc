#include "lobefit/fit/inference/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobefit {
namespace {

constexpr double kOfNormal = 0.6744897501960817;  // median of |x| of a normal distribution, in standard deviations
constexpr std::size_t kRun = 64, kMostRuns = 3200;
constexpr double kWithinNoise = 1.2, kClose = 0.1, kRough = 0.4, kLeastExplained = 0.1;

double Median(std::vector<double>* values) {
  if (values->empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

bool SameIncidence(const KernelSamples& samples, std::size_t i, std::size_t j) {
  double product = 0;
  for (std::size_t k = 0; k < 3; ++k) product += samples.direction[k][i] * samples.direction[k][j];
  return product > 1 - 1e-4;  // half a degree: tables of half vectors move both directions
}

// Standard deviation from second differences of `value` over neighbours of one incidence.
template <class Value>
double LocalNoise(const KernelSamples& samples, const std::vector<std::size_t>& runs, const Value& value) {
  std::vector<double> differences;
  for (const std::size_t begin : runs) {
    for (std::size_t i = begin + 1; i + 1 < std::min(samples.count, begin + kRun); ++i) {
      if (!SameIncidence(samples, i - 1, i + 1)) continue;
      const double d = value(i - 1) - 2 * value(i) + value(i + 1);
      if (std::isfinite(d)) differences.push_back(std::fabs(d));
    }
  }
  constexpr std::size_t kFewest = 20;
  if (differences.size() < kFewest) return std::numeric_limits<double>::quiet_NaN();
  return Median(&differences) / (kOfNormal * std::sqrt(6.0));
}

}  // namespace

Verdict JudgeFit(const Problem& problem, const Layout& layout, const std::vector<double>& u, double explained,
                 ThreadPool* pool) {
  const KernelSamples& samples = problem.kernel_samples();
  const std::size_t step = std::max<std::size_t>(1, samples.count / kRun / kMostRuns) * kRun;
  std::vector<std::size_t> runs;
  for (std::size_t begin = 0; begin < samples.count; begin += step) runs.push_back(begin);
  const KernelModel kernel = layout.ToKernel(u.data());
  std::vector<std::vector<std::vector<double>>> predicted(runs.size());
  pool->Run(runs.size(), [&](std::size_t r) {
    ModelValues(samples, kernel, runs[r], std::min(samples.count, runs[r] + kRun), &predicted[r]);
  });
  std::vector<double> errors, noises;
  for (std::size_t c = 0; c < problem.channels(); ++c) {
    const double* measured = samples.measured[c];
    std::vector<double> values;
    for (const std::size_t begin : runs)
      values.insert(values.end(), measured + begin, measured + std::min(samples.count, begin + kRun));
    const auto quarter = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
    std::nth_element(values.begin(), quarter, values.end());
    const double least = *quarter;
    const double floor = LocalNoise(samples, runs, [&](std::size_t i) {
      return measured[i] <= least ? measured[i] : std::numeric_limits<double>::quiet_NaN();
    });
    const double above = std::max(0.0, std::isfinite(floor) ? 3 * floor : 0.0);
    const double noise = LocalNoise(samples, runs, [&](std::size_t i) {
      return measured[i] > above ? std::log(measured[i]) : std::numeric_limits<double>::quiet_NaN();
    });
    if (std::isfinite(noise)) noises.push_back(noise);
    for (std::size_t r = 0; r < runs.size(); ++r) {
      for (std::size_t i = 0; i < predicted[r][c].size(); ++i) {
        const double m = measured[runs[r] + i], f = predicted[r][c][i];
        if (m > above) errors.push_back(f > 0 ? std::fabs(std::log(f / m)) : std::numeric_limits<double>::max());
      }
    }
  }
  Verdict verdict;
  verdict.typical_error = Median(&errors);
  verdict.noise = Median(&noises);
  verdict.explained = explained;
  const double error = verdict.typical_error;
  if (!(error <= kRough) || explained < kLeastExplained) {
    verdict.kind = VerdictKind::kDoesNotDescribe;
  } else if (error <= kWithinNoise * kOfNormal * verdict.noise) {
    verdict.kind = VerdictKind::kWithinNoise;
  } else {
    verdict.kind = error <= kClose ? VerdictKind::kClose : VerdictKind::kRough;
  }
  return verdict;
}

}  // namespace lobefit
