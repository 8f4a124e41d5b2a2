// Numerical integration in one dimension: Gauss-Legendre rules of any order, and an adaptive Gauss-Kronrod integrator
// for vectors of integrands (a value and its gradient share one subdivision, so that the gradient is that of the
// value).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace lobefit {

// Nodes (ascending) and weights on [-1, 1].
struct QuadratureRule {
  std::vector<double> nodes;
  std::vector<double> weights;
};

// Gauss-Legendre rule of n >= 1 points, exact for polynomials up to degree 2 n - 1; nodes and weights rounded from
// extended precision. Cost O(n^2): make the rule once and keep it.
QuadratureRule GaussLegendre(int n);

// Integral of f over [a, b] by `rule`.
template <class F>
double Integrate(const QuadratureRule& rule, double a, double b, const F& f) {
  const double center = 0.5 * (a + b), half = 0.5 * (b - a);
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) sum += rule.weights[i] * f(center + half * rule.nodes[i]);
  return half * sum;
}

// `relative` is meant against the integral of the integrand's absolute value (so that a component that integrates to
// zero can converge), for every component. Subdivision ends at `max_intervals`; the result then says that it did not
// converge.
struct QuadratureOptions {
  double relative = 1e-12;
  double absolute = 0;
  int max_intervals = 1000;
};

template <std::size_t N>
struct QuadratureResult {
  std::array<double, N> value;
  std::array<double, N> error;  // estimate, never below the rounding of the sum
  bool converged;
};

namespace internal {

// The 7-point Gauss rule (every second node, starting with the centre) inside the 15-point Kronrod rule; nodes >= 0.
inline constexpr std::array<double, 8> kKronrodNodes = {0.0,
                                                        0.207784955007898467600689403773244913,
                                                        0.405845151377397166906606412076961463,
                                                        0.586087235467691130294144838258729598,
                                                        0.741531185599394439863864773280788407,
                                                        0.864864423359769072789712788640926201,
                                                        0.949107912342758524526189684047851262,
                                                        0.991455371120812639206854697526328517};
inline constexpr std::array<double, 8> kKronrodWeights = {
    0.209482141084727828012999174891714264, 0.204432940075298892414161999234649085,
    0.190350578064785409913256402421013683, 0.169004726639267902826583426598550284,
    0.140653259715525918745189590510237920, 0.104790010322250183839876322541518017,
    0.063092092629978553290700663189204287, 0.022935322010529224963732008058969592};
inline constexpr std::array<double, 4> kGaussWeights = {
    0.417959183673469387755102040816326531, 0.381830050505118944950369775488975134,
    0.279705391489276667901467771423779582, 0.129484966168869693270611432679082018};

template <std::size_t N>
struct QuadratureInterval {
  double a, b;
  std::array<double, N> value, error, absolute;
};

// One interval by Gauss-Kronrod; the error estimate is that of Piessens et al., QUADPACK (1983), section 2.2.1.
template <std::size_t N, class F>
QuadratureInterval<N> KronrodInterval(const F& f, double a, double b) {
  const double center = 0.5 * (a + b), half = 0.5 * (b - a);
  std::array<std::array<double, N>, 15> sample;
  sample[7] = f(center);
  for (int i = 1; i < 8; ++i) {
    sample[7 - i] = f(center - half * kKronrodNodes[i]);
    sample[7 + i] = f(center + half * kKronrodNodes[i]);
  }
  QuadratureInterval<N> result{a, b, {}, {}, {}};
  for (std::size_t c = 0; c < N; ++c) {
    double kronrod = kKronrodWeights[0] * sample[7][c], gauss = kGaussWeights[0] * sample[7][c];
    double absolute = std::fabs(kronrod);
    for (int i = 1; i < 8; ++i) {
      const double lower = sample[7 - i][c], upper = sample[7 + i][c];
      kronrod += kKronrodWeights[i] * (lower + upper);
      absolute += kKronrodWeights[i] * (std::fabs(lower) + std::fabs(upper));
      if (i % 2 == 0) gauss += kGaussWeights[i / 2] * (lower + upper);
    }
    double spread = 0;
    for (int i = -7; i < 8; ++i) spread += kKronrodWeights[std::abs(i)] * std::fabs(sample[7 + i][c] - 0.5 * kronrod);
    double error = std::fabs(kronrod - gauss);
    if (spread > 0 && error > 0) error = spread * std::fmin(1.0, std::pow(200 * error / spread, 1.5));
    result.value[c] = half * kronrod;
    result.absolute[c] = std::fabs(half) * absolute;
    result.error[c] =
        std::fmax(std::fabs(half) * error, 4 * std::numeric_limits<double>::epsilon() * result.absolute[c]);
  }
  return result;
}

}  // namespace internal

// Integral of f : double -> std::array<double, N> over [breaks.front(), breaks.back()]. `breaks` (ascending, at least
// two) names the places where f has a kink, a jump or changes its scale. The interval of the largest error is halved
// until every component meets the tolerance. Sums run in the order of position: the result does not depend on the order
// of refinement.
template <std::size_t N, class F>
QuadratureResult<N> IntegrateAdaptive(const F& f, const std::vector<double>& breaks,
                                      const QuadratureOptions& options = {}) {
  using Interval = internal::QuadratureInterval<N>;
  std::vector<Interval> intervals;
  std::array<double, N> error{}, absolute{};
  const auto tolerance = [&](std::size_t c) {
    const double rounding = 8 * std::numeric_limits<double>::epsilon() * absolute[c];
    return std::fmax(std::fmax(options.absolute, options.relative * absolute[c]), rounding);
  };
  const auto account = [&](const Interval& interval, double sign) {
    for (std::size_t c = 0; c < N; ++c) {
      error[c] += sign * interval.error[c];
      absolute[c] += sign * interval.absolute[c];
    }
  };
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    if (!(breaks[i] < breaks[i + 1])) continue;
    intervals.push_back(internal::KronrodInterval<N>(f, breaks[i], breaks[i + 1]));
    account(intervals.back(), 1);
  }
  // Ordered by the largest error that an interval had, relative to the integral of |f| as known when it was made.
  const auto badness = [&](const Interval& interval) {
    double worst = 0;
    for (std::size_t c = 0; c < N; ++c) {
      const double scale = std::fmax(tolerance(c), std::numeric_limits<double>::min());
      worst = std::fmax(worst, interval.error[c] / scale);
    }
    return worst;
  };
  std::priority_queue<std::pair<double, std::size_t>> queue;
  for (std::size_t i = 0; i < intervals.size(); ++i) queue.emplace(badness(intervals[i]), i);
  const auto converged = [&] {
    for (std::size_t c = 0; c < N; ++c) {
      if (!(error[c] <= tolerance(c))) return false;
    }
    return true;
  };
  bool done = converged();
  while (!done && !queue.empty() && static_cast<int>(intervals.size()) < options.max_intervals) {
    const std::size_t index = queue.top().second;
    queue.pop();
    const Interval parent = intervals[index];
    const double middle = 0.5 * (parent.a + parent.b);
    if (!(parent.a < middle && middle < parent.b)) continue;
    account(parent, -1);
    intervals[index] = internal::KronrodInterval<N>(f, parent.a, middle);
    intervals.push_back(internal::KronrodInterval<N>(f, middle, parent.b));
    for (const std::size_t i : {index, intervals.size() - 1}) {
      account(intervals[i], 1);
      queue.emplace(badness(intervals[i]), i);
    }
    done = converged();
  }
  std::sort(intervals.begin(), intervals.end(), [](const Interval& x, const Interval& y) { return x.a < y.a; });
  QuadratureResult<N> result{{}, {}, done};
  for (const Interval& interval : intervals) {
    for (std::size_t c = 0; c < N; ++c) {
      result.value[c] += interval.value[c];
      result.error[c] += interval.error[c];
    }
  }
  return result;
}

// The same for one integrand, f : double -> double.
template <class F>
double IntegrateAdaptive(const F& f, double a, double b, const QuadratureOptions& options = {}) {
  const auto wrapped = [&f](double x) { return std::array<double, 1>{f(x)}; };
  return IntegrateAdaptive<1>(wrapped, std::vector<double>{a, b}, options).value[0];
}

}  // namespace lobefit
