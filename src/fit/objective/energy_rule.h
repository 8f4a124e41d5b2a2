// A fit that reflects no more than it receives: the directional albedo at given incident directions as a part of the
// cost.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/coordinates/coordinates.h"

namespace lobefit {

// Adds weight / 2 times the sum over directions and channels of max(0, albedo - limit)^2 to the cost. The albedo is a
// fixed sum over directions wo: those that the lobes of some model send light to, each counted by how often all of them
// do, so that it is smooth in the parameters and near the integral for models near that one. Memory: some 2000 points
// a direction for each lobe.
class EnergyRule {
 public:
  EnergyRule(std::vector<Vec3> wi, double limit);

  const std::vector<Vec3>& wi() const { return wi_; }
  void SetWeight(double weight) { weight_ = weight; }
  // Chooses the points for models near `kernel`.
  void Place(const KernelModel& kernel);

  // The part of the cost at `u`; added to its Gauss-Newton matrix and gradient, null skips them.
  double Add(const Layout& layout, const double* u, ThreadPool* pool, Eigen::MatrixXd* hessian,
             Eigen::VectorXd* gradient) const;

 private:
  struct Points {
    std::vector<double> direction[6], weight;  // weight: of f_r cos_theta_i
  };

  std::vector<Vec3> wi_;
  double limit_, weight_ = 0;
  std::vector<Points> points_;  // of each wi
};

}  // namespace lobefit
