#include "lobefit/fit/search/descent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "lobefit/fit/search/active_set.h"
#include "lobefit/fit/search/gram_cost.h"
#include "lobefit/fit/search/kink.h"

namespace lobefit {
namespace {

// A tenth of a standard error.
constexpr double kGainOfStandardError = 0.01;
// A descent may end at a kink, or leave a coordinate at a bound that it would rather leave again: it goes on from the
// better point.
constexpr int kMaxRounds = 8;

// Half the squares that rounding leaves of exact values.
double Rounding(const BoundedObjective& objective) { return 0.5e-24 * static_cast<double>(objective.residuals); }

double Evaluate(const BoundedObjective& objective, const Eigen::VectorXd& u, Eigen::MatrixXd* gram,
                Eigen::VectorXd* gradient) {
  return objective.evaluate(u, gram, gradient);
}
double Evaluate(const BoundedObjective& objective, const Eigen::VectorXd& u, ArrowMatrix* gram,
                Eigen::VectorXd* gradient) {
  return objective.evaluate_arrow(u, gram, gradient);
}

Eigen::VectorXd DiagonalOf(const Eigen::MatrixXd& gram) { return gram.diagonal(); }
Eigen::VectorXd DiagonalOf(const ArrowMatrix& gram) { return gram.Diagonal(); }
void AddToDiagonal(const Eigen::VectorXd& values, Eigen::MatrixXd* gram) { gram->diagonal() += values; }
void AddToDiagonal(const Eigen::VectorXd& values, ArrowMatrix* gram) { gram->AddToDiagonal(values); }
bool AllFinite(const Eigen::MatrixXd& gram) { return gram.allFinite(); }
bool AllFinite(const ArrowMatrix& gram) { return gram.AllFinite(); }

// Goes on from `at` by a step along the kink between it and the point that was refused; false where there is none, or
// the cost does not fall.
bool GoAlongKink(const BoundedObjective& objective, const CostModel& refused, const Eigen::VectorXd& damping,
                 Descent* at) {
  const CostModel here = {at->u, at->cost, at->gram, at->gradient};
  if (!IsBeyondKink(here, refused)) return false;
  const Eigen::VectorXd u = (at->u + StepAlongKink(here, refused, damping, objective.low, objective.high))
                                .cwiseMax(objective.low)
                                .cwiseMin(objective.high);
  CostModel next = {u, 0, {}, {}};
  next.cost = Evaluate(objective, u, &next.gram, &next.gradient);
  if (!(next.cost < at->cost) || !AllFinite(next.gram)) return false;
  at->u = u;
  at->cost = next.cost;
  at->gram = std::move(next.gram);
  at->gradient = std::move(next.gradient);
  return true;
}

// Marquardt's damping, by the diagonal of J^T J; steps are the minima of the damped model within the box. From a point
// whose cost, gram and gradient are known.
template <class Gram>
void DescendPlainly(const BoundedObjective& objective, const DescentOptions& options, Descent* at, Gram* at_gram) {
  Gram damped, gram;
  Eigen::VectorXd gradient;
  double damping = 1e-3, growth = 2;
  while (at->iterations < options.max_iterations && damping < 1e12) {
    ++at->iterations;
    damped = *at_gram;
    const Eigen::VectorXd diagonal = DiagonalOf(*at_gram);
    const double floor = options.damping_floor * std::max(diagonal.maxCoeff(), 1e-300);
    AddToDiagonal((damping * diagonal.array().max(floor) + floor + 1e-300).matrix(), &damped);
    const Eigen::VectorXd step = BoundedStep(damped, at->gradient, objective.low - at->u, objective.high - at->u);
    const Eigen::VectorXd tried = (at->u + step).cwiseMax(objective.low).cwiseMin(objective.high);
    const double cost = Evaluate(objective, tried, &gram, &gradient);
    // A small decrease under strong damping says nothing of the minimum.
    const bool free = damping <= 1;
    if (!(cost < at->cost) || !AllFinite(gram)) {
      if (free && -step.dot(at->gradient) <= options.function_tolerance * at->cost) break;
      if constexpr (std::is_same_v<Gram, Eigen::MatrixXd>) {
        const Eigen::VectorXd added = damped.diagonal() - diagonal;
        if (options.along_kinks && std::isfinite(cost) && AllFinite(gram) &&
            GoAlongKink(objective, {tried, cost, gram, gradient}, added, at)) {
          damping = std::max(damping / 2, 1e-12);
          continue;
        }
      }
      damping *= growth;
      growth *= 2;
      continue;
    }
    const bool last = free && at->cost - cost <= options.function_tolerance * at->cost;
    at->u = tried;
    at->cost = cost;
    std::swap(*at_gram, gram);
    at->gradient.swap(gradient);
    if (last) break;
    damping = std::max(damping / 5, 1e-12);
    growth = 2;
  }
}

// GainOf by the diagonal entry of the Gauss-Newton matrix.
double GainBy(const BoundedObjective& objective, const Eigen::VectorXd& u, double cost, double curvature,
              const Eigen::VectorXd& gradient, Eigen::Index k) {
  if (IsHeld(objective, u, gradient, k) || !(curvature > 0) || cost <= Rounding(objective)) return 0;
  // No further than to its bound.
  const double step = std::clamp(u(k) - gradient(k) / curvature, objective.low(k), objective.high(k)) - u(k);
  return -step * (gradient(k) + 0.5 * curvature * step) / cost;
}

bool IsMinimumBy(const BoundedObjective& objective, const Eigen::VectorXd& u, double cost,
                 const Eigen::VectorXd& diagonal, const Eigen::VectorXd& gradient, double tolerance,
                 Eigen::VectorXd* better) {
  const double least = std::max(10 * tolerance, kGainOfStandardError / static_cast<double>(objective.residuals));
  for (Eigen::Index k = 0; k < u.size(); ++k) {
    if (GainBy(objective, u, cost, diagonal(k), gradient, k) <= least) continue;
    for (const double share : {1.0, 0.1, 0.01, 0.001}) {
      Eigen::VectorXd tried = u;
      tried(k) = std::clamp(u(k) - share * gradient(k) / diagonal(k), objective.low(k), objective.high(k));
      if (!(objective.evaluate(tried, nullptr, nullptr) < cost * (1 - least))) continue;
      if (better != nullptr) *better = tried;
      return false;
    }
  }
  return true;
}

// Descends from `at` in rounds, with J^T J as `gram`; `steps` takes it from the point on.
template <class Gram, class Steps>
void DescendInRounds(const BoundedObjective& objective, const DescentOptions& options, const Steps& steps, Gram* gram,
                     Descent* at) {
  at->cost = Evaluate(objective, at->u, gram, &at->gradient);
  if (!std::isfinite(at->cost) || !AllFinite(*gram) || !at->gradient.allFinite()) {
    at->cost = std::numeric_limits<double>::infinity();
    at->message = "the start has no finite cost";
    return;
  }
  for (int round = 0; round < kMaxRounds && at->iterations < options.max_iterations; ++round) {
    steps();
    Eigen::VectorXd better;
    at->converged =
        std::isfinite(at->cost) && AllFinite(*gram) && at->gradient.allFinite() &&
        IsMinimumBy(objective, at->u, at->cost, DiagonalOf(*gram), at->gradient, options.function_tolerance, &better);
    if (at->converged || better.size() == 0) break;
    at->u = better;
    at->cost = Evaluate(objective, at->u, gram, &at->gradient);
  }
  if (!at->converged)
    at->message = "the cost still falls where the descent ended" + (at->message.empty() ? "" : ": " + at->message);
}

}  // namespace

bool IsHeld(const BoundedObjective& objective, const Eigen::VectorXd& u, const Eigen::VectorXd& gradient,
            Eigen::Index k) {
  return (u(k) <= objective.low(k) && gradient(k) > 0) || (u(k) >= objective.high(k) && gradient(k) < 0);
}

double GainOf(const BoundedObjective& objective, const Eigen::VectorXd& u, double cost, const Eigen::MatrixXd& gram,
              const Eigen::VectorXd& gradient, Eigen::Index k) {
  return GainBy(objective, u, cost, gram(k, k), gradient, k);
}

bool IsMinimum(const BoundedObjective& objective, const Eigen::VectorXd& u, double cost, const Eigen::MatrixXd& gram,
               const Eigen::VectorXd& gradient, double tolerance, Eigen::VectorXd* better) {
  return std::isfinite(cost) && gram.allFinite() && gradient.allFinite() &&
         IsMinimumBy(objective, u, cost, gram.diagonal(), gradient, tolerance, better);
}

Descent Descend(const BoundedObjective& objective, const Eigen::VectorXd& start, const DescentOptions& options) {
  Descent at;
  at.u = start.cwiseMax(objective.low).cwiseMin(objective.high);
  if (objective.evaluate_arrow) {
    ArrowMatrix gram;
    DescendInRounds(
        objective, options, [&] { DescendPlainly(objective, options, &at, &gram); }, &gram, &at);
    return at;
  }
  const auto steps = [&] {
    if (options.use_ceres) {
      DescendWithCeres(objective, options, &at);
    } else {
      DescendPlainly(objective, options, &at, &at.gram);
    }
  };
  DescendInRounds(objective, options, steps, &at.gram, &at);
  return at;
}

Eigen::VectorXd BoundedStep(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient, const Eigen::VectorXd& low,
                            const Eigen::VectorXd& high) {
  const Eigen::Index n = gradient.size();
  Eigen::VectorXd right(n);
  Eigen::MatrixXd h(n, n);
  const auto minimum = [&](const std::vector<char>& held, const Eigen::VectorXd& x) -> Eigen::VectorXd {
    h = hessian;
    right = -gradient;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (held[static_cast<std::size_t>(i)] != 0 && x(i) != 0) right -= hessian.col(i) * x(i);
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      const bool fixed = held[static_cast<std::size_t>(i)] != 0;
      if (!fixed && hessian(i, i) > 0) continue;
      h.row(i).setZero();
      h.col(i).setZero();
      h(i, i) = 1;
      right(i) = fixed ? x(i) : 0.0;
    }
    return h.ldlt().solve(right);
  };
  return StepByActiveSet(low, high, gradient, std::vector<char>(static_cast<std::size_t>(n), 0),
                         Eigen::VectorXd::Zero(n), minimum,
                         [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return hessian * x; });
}

}  // namespace lobefit
