// Carlson's symmetric elliptic integrals R_F and R_D by duplication [Carlson 1995, "Numerical computation of real or
// complex elliptic integrals", algorithms for R_F and R_D], templated on the scalar so that derivatives follow the same
// recursion.
#pragma once

#include <cmath>

namespace lobefit {
namespace internal {

// Duplications until the arguments agree so well that the truncated series is exact to rounding: 4^-n spread < 1e-3
// mean.
template <class T>
int CarlsonSteps(const T& mean, const T& spread) {
  int steps = 1;
  for (T s = spread; s > 1e-3 * mean && steps < 600; s = s * 0.25) ++steps;
  return steps;
}

template <class T>
T CarlsonMax(const T& a, const T& b) {
  return a < b ? b : a;
}
template <class T>
T CarlsonAbs(const T& a) {
  return a < 0.0 ? -a : a;
}

}  // namespace internal

// R_F(x, y, z) = 1/2 int_0^inf ds / sqrt((s+x)(s+y)(s+z)); x, y, z >= 0, at most one of them 0.
template <class T>
T CarlsonRF(T x, T y, T z) {
  using internal::CarlsonAbs;
  using internal::CarlsonMax;
  using std::sqrt;
  const T mean0 = (x + y + z) / 3.0;
  const T spread = CarlsonMax(CarlsonMax(CarlsonAbs(mean0 - x), CarlsonAbs(mean0 - y)), CarlsonAbs(mean0 - z));
  T mean = mean0, dx = mean0 - x, dy = mean0 - y;
  const int steps = internal::CarlsonSteps(mean0, spread);
  for (int i = 0; i < steps; ++i) {
    const T lambda = sqrt(x) * sqrt(y) + sqrt(x) * sqrt(z) + sqrt(y) * sqrt(z);
    x = (x + lambda) * 0.25;
    y = (y + lambda) * 0.25;
    z = (z + lambda) * 0.25;
    mean = (mean + lambda) * 0.25;
    dx = dx * 0.25;
    dy = dy * 0.25;
  }
  const T X = dx / mean, Y = dy / mean, Z = -X - Y;
  const T e2 = X * Y - Z * Z, e3 = X * Y * Z;
  return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / sqrt(mean);
}

// R_D(x, y, z) = 3/2 int_0^inf ds / ((s+z) sqrt((s+x)(s+y)(s+z))); x, y >= 0, at most one of them 0; z > 0.
template <class T>
T CarlsonRD(T x, T y, T z) {
  using internal::CarlsonAbs;
  using internal::CarlsonMax;
  using std::sqrt;
  const T mean0 = (x + y + 3.0 * z) / 5.0;
  const T spread = CarlsonMax(CarlsonMax(CarlsonAbs(mean0 - x), CarlsonAbs(mean0 - y)), CarlsonAbs(mean0 - z));
  T mean = mean0, dx = mean0 - x, dy = mean0 - y, sum(0.0);
  double power = 1;
  const int steps = internal::CarlsonSteps(mean0, spread);
  for (int i = 0; i < steps; ++i) {
    const T lambda = sqrt(x) * sqrt(y) + sqrt(x) * sqrt(z) + sqrt(y) * sqrt(z);
    sum = sum + power / (sqrt(z) * (z + lambda));
    power *= 0.25;
    x = (x + lambda) * 0.25;
    y = (y + lambda) * 0.25;
    z = (z + lambda) * 0.25;
    mean = (mean + lambda) * 0.25;
    dx = dx * 0.25;
    dy = dy * 0.25;
  }
  const T X = dx / mean, Y = dy / mean, Z = -(X + Y) / 3.0;
  const T e2 = X * Y - 6.0 * Z * Z, e3 = (3.0 * X * Y - 8.0 * Z * Z) * Z, e4 = 3.0 * (X * Y - Z * Z) * Z * Z,
          e5 = X * Y * Z * Z * Z;
  const T series = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 - 3.0 * e4 / 22.0 - 9.0 * e2 * e3 / 52.0 +
                   3.0 * e5 / 26.0;
  return power * series / (mean * sqrt(mean)) + 3.0 * sum;
}

}  // namespace lobefit
