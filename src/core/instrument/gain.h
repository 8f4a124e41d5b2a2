// The gain of one incidence: lamp and alignment drift between incident directions, common to all samples of one. With
// a normal prior it is solved for within the residual, so that it needs no parameter of the search.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

namespace lobefit {

// `gain` is the factor for a linear residual and its logarithm for asinh; `cost` the sum of squares with the prior's.
template <class T>
struct ProfiledGain {
  T gain, cost;
};

// min over g of sum ((g f - y) / sd)^2 + ((g - 1) / s)^2; f model, y measured, s > 0 the prior's standard deviation.
// dcost_df: `count` derivatives at the best g (null skips them), 2 g (g f - y) / sd^2, as g does not move the minimum.
template <class T>
ProfiledGain<T> ProfileLinearGain(const T* f, const T* y, const T* sd, std::size_t count, T s, T* dcost_df) {
  T above = 1 / (s * s), below = above;
  for (std::size_t j = 0; j < count; ++j) {
    const T weight = 1 / (sd[j] * sd[j]);
    above += weight * f[j] * y[j];
    below += weight * f[j] * f[j];
  }
  const T g = above / below;
  T cost = (g - 1) * (g - 1) / (s * s);
  for (std::size_t j = 0; j < count; ++j) {
    const T r = (g * f[j] - y[j]) / sd[j];
    cost += r * r;
    if (dcost_df != nullptr) dcost_df[j] = 2 * g * r / sd[j];
  }
  return {g, cost};
}

// min over ln g of sum (T(g f) - T(y))^2 + (ln g / s)^2, T(v) = asinh(v / knee) / rho: noise with a floor of knee rho
// and a relative part rho has the standard deviation 1 in it. Newton's steps, of Gauss and Newton where the curvature
// is small.
template <class T>
ProfiledGain<T> ProfileAsinhGain(const T* f, const T* y, std::size_t count, T knee, T rho, T s, T* dcost_df) {
  using std::asinh;
  using std::exp;
  using std::fabs;
  using std::hypot;
  constexpr int kMostSteps = 100;
  const T precision = std::numeric_limits<T>::epsilon() * s;
  T w = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    const T g = exp(w);
    T slope = w / (s * s), square = 1 / (s * s), bend = 0;
    for (std::size_t j = 0; j < count; ++j) {
      const T v = g * f[j], length = hypot(v, knee);
      const T r = (asinh(v / knee) - asinh(y[j] / knee)) / rho, dr = v / (length * rho);
      slope += dr * r;
      square += dr * dr;
      bend += r * dr * (knee / length) * (knee / length);
    }
    const T curvature = square + bend > square / 2 ? square + bend : square;
    const T move = slope / curvature;
    w -= move;
    if (fabs(move) <= precision) break;
  }
  const T g = exp(w);
  T cost = (w / s) * (w / s);
  for (std::size_t j = 0; j < count; ++j) {
    const T v = g * f[j];
    const T r = (asinh(v / knee) - asinh(y[j] / knee)) / rho;
    cost += r * r;
    if (dcost_df != nullptr) dcost_df[j] = 2 * r * g / (hypot(v, knee) * rho);
  }
  return {w, cost};
}

}  // namespace lobefit
