// The one bounded descent behind every fit: Levenberg-Marquardt on an objective that gives its cost, gradient and
// Gauss-Newton matrix.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include <Eigen/Core>

#include "lobefit/fit/coordinates/arrow.h"

namespace lobefit {

// A sum of squares over a box.
struct BoundedObjective {
  Eigen::VectorXd low, high;
  // Half the sum of squares at a point within the box; with `gram` and `gradient` (both or none) also J^T J and J^T r.
  std::function<double(const Eigen::VectorXd& u, Eigen::MatrixXd* gram, Eigen::VectorXd* gradient)> evaluate;
  std::size_t residuals = 1;  // their number: what is left of exact values is rounding, 1e-12 on average
  // The same with J^T J as an arrow; may be empty. Where it is there, descents take plain steps through it
  // (DescentOptions::use_ceres does not count) and leave Descent::gram empty: linear in the channels, not cubic.
  std::function<double(const Eigen::VectorXd& u, ArrowMatrix* gram, Eigen::VectorXd* gradient)> evaluate_arrow;
};

struct DescentOptions {
  int max_iterations = 300;
  double function_tolerance = 1e-12;  // relative decrease of the cost at which the descent ends
  // Ceres Solver takes the steps, with a secant estimate of the second derivatives that Gauss-Newton leaves out
  // (gram_cost.h). Without: 30 lines that need no set-up, for problems that are solved faster than Ceres is set up.
  bool use_ceres = false;
  // Least damping of a coordinate, relative to the largest diagonal entry of J^T J: for coordinates that nothing may
  // depend on.
  double damping_floor = 0;
  // Where a plain step is refused at a kink of the cost, one along it is tried (kink.h), a pass more. Without, a
  // descent creeps there by ever shorter steps; with it, it ends on the kink, which need not be the deepest place near
  // by, so that it is for what has crept. Dense steps only.
  bool along_kinks = false;
};

struct Descent {
  Eigen::VectorXd u;     // within the box
  double cost = 0;       // at u; infinite where the start had no finite cost
  Eigen::MatrixXd gram;  // at u
  Eigen::VectorXd gradient;
  bool converged = false;  // IsMinimum at u, and nothing else
  int iterations = 0;
  std::string message;
};

Descent Descend(const BoundedObjective& objective, const Eigen::VectorXd& start, const DescentOptions& options);

// Whether a bound holds coordinate k: it stands there and the cost falls outwards.
bool IsHeld(const BoundedObjective& objective, const Eigen::VectorXd& u, const Eigen::VectorXd& gradient,
            Eigen::Index k);

// What moving coordinate k alone within its bounds would gain by the quadratic model, g^2 / (2 H cost) where they leave
// it room, relative to the cost; 0 where it is held.
// In units of the coordinate's own standard error z from the minimum it is z^2 / residuals.
double GainOf(const BoundedObjective& objective, const Eigen::VectorXd& u, double cost, const Eigen::MatrixXd& gram,
              const Eigen::VectorXd& gradient, Eigen::Index k);

// The Karush-Kuhn-Tucker conditions: no coordinate gains more than `tolerance`, or a tenth of its standard error. Where
// the derivative promises more, the cost itself is asked, since it may have a kink there (the cube root where the model
// vanishes, the clamp of a tilted lobe); `better`, unless null, is then a point of lower cost.
bool IsMinimum(const BoundedObjective& objective, const Eigen::VectorXd& u, double cost, const Eigen::MatrixXd& gram,
               const Eigen::VectorXd& gradient, double tolerance, Eigen::VectorXd* better);

// min 1/2 x^T H x + g^T x with low <= x <= high, by an active set: what leaves its bounds is held there. A coordinate
// without curvature stays at 0.
Eigen::VectorXd BoundedStep(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient, const Eigen::VectorXd& low,
                            const Eigen::VectorXd& high);
// The same of an arrow, by the Schur complement of the channels' own blocks. A coordinate with low = high is held.
Eigen::VectorXd BoundedStep(const ArrowMatrix& hessian, const Eigen::VectorXd& gradient, const Eigen::VectorXd& low,
                            const Eigen::VectorXd& high);

}  // namespace lobefit
