#include "lobefit/math/quadrature.h"

namespace lobefit {

QuadratureRule GaussLegendre(int n) {
  constexpr long double pi = 3.14159265358979323846264338327950288L;
  QuadratureRule rule;
  rule.nodes.resize(n);
  rule.weights.resize(n);
  for (int i = 0; i < (n + 1) / 2; ++i) {
    // Newton from the asymptotic position of the root; four steps reach the rounding of long double for every n.
    long double x = std::cos(pi * (static_cast<long double>(i) + 0.75L) / (static_cast<long double>(n) + 0.5L));
    if (2 * i + 1 == n) x = 0;
    long double derivative = 0;
    for (int step = 0; step < 6; ++step) {
      long double p0 = 1, p1 = x;
      for (int l = 2; l <= n; ++l) {
        const auto order = static_cast<long double>(l);
        const long double p2 = ((2 * order - 1) * x * p1 - (order - 1) * p0) / order;
        p0 = p1;
        p1 = p2;
      }
      derivative = n == 1 ? 1.0L : static_cast<long double>(n) * (p0 - x * p1) / ((1 - x) * (1 + x));
      x -= p1 / derivative;
    }
    const auto node = static_cast<double>(x);
    const auto weight = static_cast<double>(2 / ((1 - x) * (1 + x) * derivative * derivative));
    rule.nodes[i] = -node;
    rule.nodes[n - 1 - i] = node;
    rule.weights[i] = rule.weights[n - 1 - i] = weight;
  }
  return rule;
}

}  // namespace lobefit
