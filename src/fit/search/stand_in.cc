#include "lobefit/fit/search/stand_in.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lobefit {
namespace {

// Steps within a round, a twentieth of a pass over the whole each, and the share of the whole's tolerance at which they
// end.
constexpr int kStepsWithin = 12;
constexpr double kShareOfTolerance = 0.3;
// Where the whole's cost does not fall the stand-in promised too much: its next round is damped, as Marquardt's steps,
// and those after it ever less. From 0.03 on, aluminium and a green fabric took a round more than from here.
constexpr double kFirstDamping = 0.01, kMostDamping = 1e3, kLeastDamping = 1e-4;
// Of the cosine between a way and what the gradient changed by beyond what was known: below, a correction would be of
// other directions. At 0.05 brass took five rounds in place of three.
constexpr double kLeastSecant = 0.4;
// A round that gains no more than this share of the cost is the last where the conditions of a minimum hold: on full
// tables of a gold layer, a black phenolic and a marble 12 to 18 more gained 1e-4 together.
constexpr double kSettled = 3e-6;

// A point at which the whole was evaluated, and what the part's gradient lacks of the whole's there.
struct Seen {
  Eigen::VectorXd u, lacking;
};

// `part` with what it lacks of the whole's derivatives at the point of `whole`, and of its gradient at those that were
// seen: each secant corrects the matrix by one of rank one [symmetric rank one, Conn, Gould and Toint 1991]. Without
// them full tables of teflon and a green fabric took 13 and 12 rounds, with them 6 and 8 to a cost as low or lower.
class StandIn {
 public:
  StandIn(const BoundedObjective& part, double scale, const Descent& whole, double damping,
          const std::vector<Seen>& seen)
      : part_(part), scale_(scale), from_(whole.u) {
    Eigen::MatrixXd gram;
    Eigen::VectorXd gradient;
    offset_ = whole.cost - scale * part.evaluate(from_, &gram, &gradient);
    gradient_ = whole.gradient - scale * gradient;
    gram_ = whole.gram - scale * gram;
    for (const Seen& other : seen) AddSecant(other, whole.gram);
    gram_.diagonal() += damping * whole.gram.diagonal();
  }

  // The point where it stands in.
  Seen Here() const { return {from_, gradient_}; }

  double Evaluate(const Eigen::VectorXd& u, Eigen::MatrixXd* gram, Eigen::VectorXd* gradient) const {
    const double cost = part_.evaluate(u, gram, gradient);
    const Eigen::VectorXd way = u - from_, bent = gram_ * way;
    if (gram != nullptr) {
      *gram = scale_ * *gram + gram_;
      *gradient = scale_ * *gradient + gradient_ + bent;
    }
    return scale_ * cost + offset_ + (gradient_ + 0.5 * bent).dot(way);
  }

 private:
  void AddSecant(const Seen& other, const Eigen::MatrixXd& whole) {
    const Eigen::VectorXd way = other.u - from_, missing = other.lacking - gradient_ - gram_ * way;
    const double along = missing.dot(way), length = way.dot(whole * way),
                 size = missing.cwiseAbs2().cwiseQuotient(whole.diagonal().cwiseMax(1e-300)).sum();
    if (std::fabs(along) > kLeastSecant * std::sqrt(length * size)) gram_ += missing * missing.transpose() / along;
  }

  const BoundedObjective& part_;
  double scale_, offset_;
  Eigen::VectorXd from_, gradient_;
  Eigen::MatrixXd gram_;
};

}  // namespace

Descent DescendByStandIn(const BoundedObjective& whole, const BoundedObjective& part, double scale,
                         const Eigen::VectorXd& start, const DescentOptions& options) {
  Descent at;
  at.u = start.cwiseMax(whole.low).cwiseMin(whole.high);
  at.cost = whole.evaluate(at.u, &at.gram, &at.gradient);
  DescentOptions within;
  within.max_iterations = kStepsWithin;
  within.function_tolerance = kShareOfTolerance * options.function_tolerance;
  Eigen::MatrixXd gram;
  Eigen::VectorXd gradient;
  std::vector<Seen> seen;
  double damping = 0;
  const auto is_minimum = [&] {
    return IsMinimum(whole, at.u, at.cost, at.gram, at.gradient, options.function_tolerance, nullptr);
  };
  while (std::isfinite(at.cost) && at.iterations < options.max_iterations && damping < kMostDamping) {
    ++at.iterations;
    const StandIn stand_in(part, scale, at, damping, seen);
    BoundedObjective within_round = part;
    within_round.residuals = whole.residuals;
    within_round.evaluate_arrow = nullptr;
    within_round.evaluate = [&stand_in](const Eigen::VectorXd& u, Eigen::MatrixXd* of_gram,
                                        Eigen::VectorXd* of_gradient) {
      return stand_in.Evaluate(u, of_gram, of_gradient);
    };
    const Eigen::VectorXd u = Descend(within_round, at.u, within).u;
    const double cost = whole.evaluate(u, &gram, &gradient);
    if (!(cost < at.cost)) {
      damping = std::max(kFirstDamping, 10 * damping);
      if (!std::isfinite(cost)) continue;
      Eigen::MatrixXd gram_of_part;
      Eigen::VectorXd of_part;
      part.evaluate(u, &gram_of_part, &of_part);
      seen.push_back({u, gradient - scale * of_part});
      continue;
    }
    seen.push_back(stand_in.Here());
    // A small decrease under strong damping says nothing of the minimum.
    const bool free = damping <= kFirstDamping;
    const double gain = at.cost - cost;
    const bool last = free && gain <= options.function_tolerance * at.cost;
    damping = damping > kLeastDamping ? damping / 3 : 0;
    at.u = u;
    at.cost = cost;
    at.gram.swap(gram);
    at.gradient.swap(gradient);
    at.converged = (last || (free && gain <= kSettled * at.cost)) && is_minimum();
    if (last || at.converged) break;
  }
  at.converged = at.converged || is_minimum();
  if (!at.converged) at.message = "the cost still falls where the descent ended";
  return at;
}

}  // namespace lobefit
