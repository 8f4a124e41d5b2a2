// A subsample that stands in for all samples: the minimum is that of all, in fewer passes over them.
#include "lobefit/fit/search/stand_in.h"

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace lobefit {
namespace {

// a exp(-b x) + c fitted to what no such curve describes, with noise: a Gauss-Newton step leaves 77 % of the gradient.
class Decay {
 public:
  explicit Decay(std::size_t samples) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0, 0.05);
    for (std::size_t i = 0; i < samples; ++i) {
      const double x = 4 * (static_cast<double>(i) + 0.5) / static_cast<double>(samples);
      x_.push_back(x);
      y_.push_back(1 / (1 + x * x) + 0.3 * std::sin(2 * x + 1.5) + noise(random));
    }
  }

  // Every `stride`-th sample; `passes` counts, unless null.
  BoundedObjective Of(std::size_t stride, const Eigen::Vector3d& low, int* passes) const {
    BoundedObjective objective;
    objective.low = low;
    objective.high = Eigen::Vector3d::Constant(5);
    objective.residuals = x_.size() / stride;
    objective.evaluate = [this, stride, passes](const Eigen::VectorXd& u, Eigen::MatrixXd* gram,
                                                Eigen::VectorXd* gradient) {
      if (passes != nullptr) ++*passes;
      double cost = 0;
      if (gram != nullptr) {
        gram->setZero(3, 3);
        gradient->setZero(3);
      }
      for (std::size_t i = 0; i < x_.size(); i += stride) {
        const double e = std::exp(-u(1) * x_[i]), r = u(0) * e + u(2) - y_[i];
        const Eigen::Vector3d j(e, -u(0) * x_[i] * e, 1);
        cost += r * r / 2;
        if (gram == nullptr) continue;
        *gram += j * j.transpose();
        *gradient += r * j;
      }
      return cost;
    };
    return objective;
  }

 private:
  std::vector<double> x_, y_;
};

constexpr std::size_t kStride = 16;

TEST(StandIn, EndsAtTheMinimumOfAllSamplesInFewerPasses) {
  const Decay decay(20000);
  const Eigen::Vector3d low = Eigen::Vector3d::Constant(-5);
  int steps = 0, rounds = 0;
  const BoundedObjective whole = decay.Of(1, low, &steps), counted = decay.Of(1, low, &rounds);
  const BoundedObjective part = decay.Of(kStride, low, nullptr);
  DescentOptions options;
  options.function_tolerance = 1e-10;
  const Eigen::VectorXd start = Descend(part, Eigen::Vector3d(1.4, 1.4, 0.1), options).u;
  const Descent expected = Descend(whole, start, options);
  const Descent found = DescendByStandIn(counted, part, kStride, start, options);
  ASSERT_TRUE(expected.converged);
  EXPECT_TRUE(found.converged);
  EXPECT_LT(found.cost, expected.cost * (1 + 1e-9));
  EXPECT_LT((found.u - expected.u).norm(), 1e-4);
  EXPECT_LT(2 * rounds, steps) << rounds << " " << steps;
  EXPECT_GT((start - expected.u).norm(), 1e-3);  // the part's own minimum is another
}

TEST(StandIn, HoldsTheBoundsAndAsksTheWholeWhetherItIsAMinimum) {
  const Decay decay(20000);
  const Eigen::Vector3d low(-5, -5, 0.25), start(1.4, 1.4, 0.1);
  const BoundedObjective whole = decay.Of(1, low, nullptr);
  const Descent found = DescendByStandIn(whole, decay.Of(kStride, low, nullptr), kStride, start, {});
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.u(2), 0.25);
  EXPECT_TRUE(IsHeld(whole, found.u, found.gradient, 2));
  DescentOptions once;
  once.max_iterations = 1;
  EXPECT_FALSE(DescendByStandIn(whole, decay.Of(kStride, low, nullptr), kStride, start, once).converged);
}

BoundedObjective OneThatKnowsNothing(const BoundedObjective& whole) {
  BoundedObjective part = whole;
  part.evaluate = [n = whole.low.size()](const Eigen::VectorXd&, Eigen::MatrixXd* gram, Eigen::VectorXd* gradient) {
    if (gram != nullptr) {
      gram->setZero(n, n);
      gradient->setZero(n);
    }
    return 0.0;
  };
  return part;
}

// It leaves the whole's own Gauss-Newton steps, of which each keeps 77 % of the gradient, and what the gradients at
// points seen before say of the second derivatives that are left out.
TEST(StandIn, LearnsFromThePointsThatWereSeen) {
  const Decay decay(2000);
  const Eigen::Vector3d low = Eigen::Vector3d::Constant(-5);
  int steps = 0, rounds = 0;
  const BoundedObjective whole = decay.Of(1, low, &steps), counted = decay.Of(1, low, &rounds);
  DescentOptions options;
  options.function_tolerance = 1e-12;
  const Eigen::Vector3d start(1.4, 1.4, 0.1);
  const Descent expected = Descend(whole, start, options);
  const Descent found = DescendByStandIn(counted, OneThatKnowsNothing(decay.Of(1, low, nullptr)), 1, start, options);
  EXPECT_TRUE(found.converged);
  EXPECT_LT(found.cost, expected.cost * (1 + 1e-9));
  EXPECT_LT(2 * rounds, steps) << rounds << " " << steps;
}

// From 2 the Gauss-Newton steps of the arc tangent lead further away each time, unless they are damped.
TEST(StandIn, OneThatKnowsNothingIsDamped) {
  BoundedObjective whole;
  whole.low = Eigen::VectorXd::Constant(1, -100);
  whole.high = Eigen::VectorXd::Constant(1, 100);
  whole.evaluate = [](const Eigen::VectorXd& u, Eigen::MatrixXd* gram, Eigen::VectorXd* gradient) {
    const double r = std::atan(u(0)), j = 1 / (1 + u(0) * u(0));
    if (gram != nullptr) {
      gram->setConstant(1, 1, j * j);
      gradient->setConstant(1, j * r);
    }
    return r * r / 2;
  };
  const Descent found = DescendByStandIn(whole, OneThatKnowsNothing(whole), 1, Eigen::VectorXd::Constant(1, 2), {});
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.u(0), 0, 1e-6);
  EXPECT_LT(found.iterations, 50);  // without J^T J of the whole 300
}

}  // namespace
}  // namespace lobefit
