#include "lobefit/math/student_t.h"

#include <algorithm>
#include <cmath>

#include "lobefit/math/quadrature.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

double Density(double x, double freedom) {
  if (std::isinf(freedom)) return std::exp(-x * x / 2) / std::sqrt(2 * kPi);
  const double log_factor = std::lgamma((freedom + 1) / 2) - std::lgamma(freedom / 2) - std::log(kPi * freedom) / 2;
  return std::exp(log_factor - (freedom + 1) / 2 * std::log1p(x * x / freedom));
}

}  // namespace

double StudentTCdf(double x, double freedom) {
  if (std::isinf(freedom)) return std::erfc(-x / std::sqrt(2.0)) / 2;
  // With x = sqrt(freedom) tan(angle) the density is a power of cos(angle) over a finite range.
  const double log_factor = std::lgamma((freedom + 1) / 2) - std::lgamma(freedom / 2) - std::log(kPi) / 2;
  const double end = std::atan2(std::fabs(x), std::sqrt(freedom));
  const auto part = [&](double from, double to) {
    return std::exp(log_factor) *
           IntegrateAdaptive([&](double angle) { return std::pow(std::cos(angle), freedom - 1); }, from, to,
                             {1e-14, 1e-15, 2000});
  };
  // Of a tail the tail itself: less than a half less its rest would lose all digits and could be negative.
  if (std::fabs(x) > 2) {
    const double tail = part(end, kPi / 2);
    return x < 0 ? tail : 1 - tail;
  }
  const double half = part(0, end);
  return x < 0 ? 0.5 - half : 0.5 + half;
}

double StudentTQuantile(double probability, double freedom) {
  // Bisection in a bracket that grows until it holds the quantile, then Newton's steps within it.
  const double upper = std::max(probability, 1 - probability);
  double low = 0, high = 2;
  while (StudentTCdf(high, freedom) < upper) {
    low = high;
    high *= 4;
  }
  double x = (low + high) / 2;
  for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
    const double excess = StudentTCdf(x, freedom) - upper;
    (excess > 0 ? high : low) = x;
    double next = x - excess / Density(x, freedom);
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (std::fabs(next - x) <= 1e-14 * x) break;
    x = next;
  }
  return probability < 0.5 ? -x : x;
}

}  // namespace lobefit
