// Derivatives by central differences of six points, an oracle for analytic gradients of functions in double.
#pragma once

#include <cmath>

namespace lobefit {

// df/dx at x; f takes a double. Relative error about 1e-10 for functions that change on the scale of `step` times some
// tens.
template <class F>
double Difference(const F& f, double x, double step) {
  const auto odd = [&](double k) { return f(x + k * step) - f(x - k * step); };
  return (45 * odd(1) - 9 * odd(2) + odd(3)) / (60 * step);
}

}  // namespace lobefit
