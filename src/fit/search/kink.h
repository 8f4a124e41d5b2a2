// Steps of a descent that comes to a kink of the cost: where the masking of a tilted lobe begins, at the same shape for
// all samples of one incident direction, its slope jumps.
#pragma once

#include <Eigen/Core>

namespace lobefit {

// A quadratic model of the cost about `at`, as Gauss and Newton have it.
struct CostModel {
  Eigen::VectorXd at;
  double cost = 0;
  Eigen::MatrixXd gram;
  Eigen::VectorXd gradient;
  double Change(const Eigen::VectorXd& u) const;  // cost(u) - cost
};

// Whether the cost rises at the end of the step from `here` to `there` by more than `here` explains.
bool IsBeyondKink(const CostModel& here, const CostModel& there);

// The step from `here` to the minimum within the bounds of the larger of both models, with `damping` of the diagonal:
// the models cross where the kink is, and the step ends on it [Kiwiel 1985, a bundle of two]. By halving the weight of
// the models, w here + (1 - w) there, whose minimum lies where both are equal.
Eigen::VectorXd StepAlongKink(const CostModel& here, const CostModel& there, const Eigen::VectorXd& damping,
                              const Eigen::VectorXd& low, const Eigen::VectorXd& high);

}  // namespace lobefit
