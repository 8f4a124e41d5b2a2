#include "lobefit/fit/search/descent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>

#include "lobefit/fit/search/gram_cost.h"

namespace lobefit {
namespace {

// A tenth of a standard error.
constexpr double kGainOfStandardError = 0.01;
// A descent may end at a kink, or leave a coordinate at a bound that it would rather leave again: it goes on from the
// better point.
constexpr int kMaxRounds = 8;

// Half the squares that rounding leaves of exact values.
double Rounding(const BoundedObjective& objective) { return 0.5e-24 * static_cast<double>(objective.residuals); }

// Marquardt's damping, by the diagonal of J^T J; steps are the minima of the damped model within the box. From a point
// whose cost, gram and gradient are known.
void DescendPlainly(const BoundedObjective& objective, const DescentOptions& options, Descent* at) {
  Eigen::MatrixXd damped, gram;
  Eigen::VectorXd gradient;
  double damping = 1e-3, growth = 2;
  while (at->iterations < options.max_iterations && damping < 1e12) {
    ++at->iterations;
    damped = at->gram;
    const double floor = options.damping_floor * std::max(at->gram.diagonal().maxCoeff(), 1e-300);
    damped.diagonal().array() += damping * at->gram.diagonal().array().max(floor) + floor + 1e-300;
    const Eigen::VectorXd step = BoundedStep(damped, at->gradient, objective.low - at->u, objective.high - at->u);
    const Eigen::VectorXd tried = (at->u + step).cwiseMax(objective.low).cwiseMin(objective.high);
    const double cost = objective.evaluate(tried, &gram, &gradient);
    // A small decrease under strong damping says nothing of the minimum.
    const bool free = damping <= 1;
    if (!(cost < at->cost) || !gram.allFinite()) {
      if (free && -step.dot(at->gradient) <= options.function_tolerance * at->cost) break;
      damping *= growth;
      growth *= 2;
      continue;
    }
    const bool last = free && at->cost - cost <= options.function_tolerance * at->cost;
    at->u = tried;
    at->cost = cost;
    at->gram.swap(gram);
    at->gradient.swap(gradient);
    if (last) break;
    damping = std::max(damping / 5, 1e-12);
    growth = 2;
  }
}

}  // namespace

bool IsHeld(const BoundedObjective& objective, const Eigen::VectorXd& u, const Eigen::VectorXd& gradient,
            Eigen::Index k) {
  return (u(k) <= objective.low(k) && gradient(k) > 0) || (u(k) >= objective.high(k) && gradient(k) < 0);
}

double GainOf(const BoundedObjective& objective, const Eigen::VectorXd& u, double cost, const Eigen::MatrixXd& gram,
              const Eigen::VectorXd& gradient, Eigen::Index k) {
  if (IsHeld(objective, u, gradient, k) || !(gram(k, k) > 0) || cost <= Rounding(objective)) return 0;
  // No further than to its bound.
  const double step = std::clamp(u(k) - gradient(k) / gram(k, k), objective.low(k), objective.high(k)) - u(k);
  return -step * (gradient(k) + 0.5 * gram(k, k) * step) / cost;
}

bool IsMinimum(const BoundedObjective& objective, const Eigen::VectorXd& u, double cost, const Eigen::MatrixXd& gram,
               const Eigen::VectorXd& gradient, double tolerance, Eigen::VectorXd* better) {
  if (!std::isfinite(cost) || !gram.allFinite() || !gradient.allFinite()) return false;
  const double least = std::max(10 * tolerance, kGainOfStandardError / static_cast<double>(objective.residuals));
  for (Eigen::Index k = 0; k < u.size(); ++k) {
    if (GainOf(objective, u, cost, gram, gradient, k) <= least) continue;
    for (const double share : {1.0, 0.1, 0.01, 0.001}) {
      Eigen::VectorXd tried = u;
      tried(k) = std::clamp(u(k) - share * gradient(k) / gram(k, k), objective.low(k), objective.high(k));
      if (!(objective.evaluate(tried, nullptr, nullptr) < cost * (1 - least))) continue;
      if (better != nullptr) *better = tried;
      return false;
    }
  }
  return true;
}

Descent Descend(const BoundedObjective& objective, const Eigen::VectorXd& start, const DescentOptions& options) {
  Descent at;
  at.u = start.cwiseMax(objective.low).cwiseMin(objective.high);
  at.cost = objective.evaluate(at.u, &at.gram, &at.gradient);
  if (!std::isfinite(at.cost) || !at.gram.allFinite() || !at.gradient.allFinite()) {
    at.cost = std::numeric_limits<double>::infinity();
    at.message = "the start has no finite cost";
    return at;
  }
  for (int round = 0; round < kMaxRounds && at.iterations < options.max_iterations; ++round) {
    if (options.use_ceres) {
      DescendWithCeres(objective, options, &at);
    } else {
      DescendPlainly(objective, options, &at);
    }
    Eigen::VectorXd better;
    at.converged = IsMinimum(objective, at.u, at.cost, at.gram, at.gradient, options.function_tolerance, &better);
    if (at.converged || better.size() == 0) break;
    at.u = better;
    at.cost = objective.evaluate(at.u, &at.gram, &at.gradient);
  }
  if (!at.converged)
    at.message = "the cost still falls where the descent ended" + (at.message.empty() ? "" : ": " + at.message);
  return at;
}

Eigen::VectorXd BoundedStep(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient, const Eigen::VectorXd& low,
                            const Eigen::VectorXd& high) {
  const Eigen::Index n = gradient.size();
  std::vector<char> held(static_cast<std::size_t>(n), 0);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n), right(n);
  Eigen::MatrixXd h(n, n);
  for (Eigen::Index round = 0; round <= n; ++round) {
    h = hessian;
    right = -gradient;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (held[static_cast<std::size_t>(i)] != 0) right -= hessian.col(i) * x(i);
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      const bool fixed = held[static_cast<std::size_t>(i)] != 0;
      if (!fixed && hessian(i, i) > 0) continue;
      h.row(i).setZero();
      h.col(i).setZero();
      h(i, i) = 1;
      right(i) = fixed ? x(i) : 0.0;
    }
    const Eigen::VectorXd step = h.ldlt().solve(right);
    bool left = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (held[static_cast<std::size_t>(i)] != 0) continue;
      x(i) = std::isfinite(step(i)) ? step(i) : 0.0;
      if (x(i) >= low(i) && x(i) <= high(i)) continue;
      x(i) = std::clamp(x(i), low(i), high(i));
      held[static_cast<std::size_t>(i)] = 1;
      left = true;
    }
    if (!left) break;
  }
  return x;
}

}  // namespace lobefit
