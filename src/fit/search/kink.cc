#include "lobefit/fit/search/kink.h"

#include <cmath>

#include "lobefit/fit/search/descent.h"

namespace lobefit {

double CostModel::Change(const Eigen::VectorXd& u) const {
  const Eigen::VectorXd way = u - at;
  return way.dot(gradient) + 0.5 * way.dot(gram * way);
}

bool IsBeyondKink(const CostModel& here, const CostModel& there) {
  constexpr double kJump = 0.5;  // of the slope that the step promised
  const Eigen::VectorXd way = there.at - here.at;
  const double slope = way.dot(here.gradient), expected = slope + way.dot(here.gram * way),
               found = way.dot(there.gradient);
  return found > 0 && found - expected > kJump * std::fabs(slope);
}

Eigen::VectorXd StepAlongKink(const CostModel& here, const CostModel& there, const Eigen::VectorXd& damping,
                              const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
  constexpr int kHalvings = 10;
  const Eigen::VectorXd of_there = there.gradient - there.gram * (there.at - here.at);  // its gradient at `here`
  Eigen::VectorXd step = Eigen::VectorXd::Zero(here.at.size());
  double least = 0, most = 1;
  for (int k = 0; k < kHalvings; ++k) {
    const double weight = 0.5 * (least + most);
    Eigen::MatrixXd gram = weight * here.gram + (1 - weight) * there.gram;
    gram.diagonal() += damping;
    const Eigen::VectorXd gradient = weight * here.gradient + (1 - weight) * of_there;
    step = BoundedStep(gram, gradient, low - here.at, high - here.at);
    const Eigen::VectorXd u = here.at + step;
    (there.cost + there.Change(u) > here.cost + here.Change(u) ? most : least) = weight;
  }
  return step;
}

}  // namespace lobefit
