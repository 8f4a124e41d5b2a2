// Pearson's chi-square test of samples against expected counts, for tests of samplers with fixed seeds.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lobefit {

// Upper tail of the chi-square distribution: the regularised incomplete gamma function Q(degrees / 2, x / 2).
inline double ChiSquareTail(double x, int degrees) {
  const double a = 0.5 * degrees, z = 0.5 * x;
  if (z <= 0) return 1;
  const double front = std::exp(-z + a * std::log(z) - std::lgamma(a));
  if (z < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 5000 && term > 1e-17 * sum; ++n) sum += term *= z / (a + n);
    return 1 - front * sum;
  }
  // Continued fraction by Lentz's method.
  double b = z + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int n = 1; n < 5000; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= c * d;
    if (std::fabs(c * d - 1) < 1e-15) break;
  }
  return front * h;
}

// p-value of counts against expected counts (same total but for rounding). Bins that expect fewer than 5 are pooled; a
// bin that expects nothing but has samples gives 0.
inline double ChiSquarePValue(const std::vector<double>& counts, const std::vector<double>& expected) {
  std::vector<std::size_t> order(counts.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return expected[i] < expected[j]; });
  double statistic = 0, pooled_count = 0, pooled_expected = 0;
  int bins = 0;
  for (const std::size_t i : order) {
    if (expected[i] <= 0 && counts[i] > 0) return 0;
    pooled_count += counts[i];
    pooled_expected += expected[i];
    if (pooled_expected < 5 && i != order.back()) continue;
    if (pooled_expected > 0) {
      const double difference = pooled_count - pooled_expected;
      statistic += difference * difference / pooled_expected;
      ++bins;
    }
    pooled_count = pooled_expected = 0;
  }
  return bins > 1 ? ChiSquareTail(statistic, bins - 1) : 1;
}

// The smallest p-value to accept in each of `tests` tests so that all pass with probability 1 - significance [Sidak
// 1967].
inline double SidakThreshold(double significance, int tests) { return 1 - std::pow(1 - significance, 1.0 / tests); }

}  // namespace lobefit
