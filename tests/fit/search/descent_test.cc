// The bounded descent against Ceres Solver's own bounds, and its verdict.
#include "lobefit/fit/search/descent.h"

#include <cmath>
#include <limits>
#include <random>

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include "lobefit/fit/search/kink.h"

namespace lobefit {
namespace {

// Least squares of y = a exp(b x) + c to points with noise.
struct Curve3 {
  std::vector<double> x, y;

  explicit Curve3(unsigned seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, 0.05);
    for (int i = 0; i < 60; ++i) {
      x.push_back(i / 20.0);
      y.push_back(1.5 * std::exp(-0.8 * x.back()) - 0.1 + normal(random));
    }
  }

  template <class T>
  T Residual(std::size_t i, const T& a, const T& b, const T& c) const {
    using std::exp;
    return a * exp(b * x[i]) + c - y[i];
  }

  double Evaluate(const Eigen::VectorXd& u, Eigen::MatrixXd* gram, Eigen::VectorXd* gradient) const {
    using Jet = ceres::Jet<double, 3>;
    double sum = 0;
    if (gram != nullptr) {
      gram->setZero(3, 3);
      gradient->setZero(3);
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Jet r = Residual(i, Jet(u(0), 0), Jet(u(1), 1), Jet(u(2), 2));
      sum += r.a * r.a;
      if (gram == nullptr) continue;
      *gram += r.v * r.v.transpose();
      *gradient += r.a * r.v;
    }
    return sum / 2;
  }

  BoundedObjective Within(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const {
    BoundedObjective objective;
    objective.low = low;
    objective.high = high;
    objective.residuals = x.size();
    objective.evaluate = [this](const Eigen::VectorXd& u, Eigen::MatrixXd* gram, Eigen::VectorXd* gradient) {
      return Evaluate(u, gram, gradient);
    };
    return objective;
  }
};

struct CeresResidual {
  const Curve3* curve;
  std::size_t i;
  template <class T>
  bool operator()(const T* u, T* r) const {
    r[0] = curve->Residual(i, u[0], u[1], u[2]);
    return true;
  }
};

// Ceres with an AutoDiff block a point, once for each choice of coordinates that stand at a bound: the best of what
// lies within the box. (Its own bounds stop short: up to 0.1 away, at a higher cost.)
Eigen::Vector3d SolvedByCeres(const Curve3& curve, const Eigen::Vector3d& start, const Eigen::Vector3d& low,
                              const Eigen::Vector3d& high) {
  Eigen::Vector3d best = start;
  double least = std::numeric_limits<double>::infinity();
  for (int choice = 0; choice < 27; ++choice) {
    const int places[] = {choice % 3, choice / 3 % 3, choice / 9};  // free, at the low bound, at the high one
    Eigen::Vector3d u = start;
    std::vector<int> held;
    for (int k = 0; k < 3; ++k) {
      if (places[k] == 0) continue;
      u(k) = places[k] == 1 ? low(k) : high(k);
      held.push_back(k);
    }
    if (held.size() < 3) {
      ceres::Problem problem;
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<CeresResidual, 1, 3>(new CeresResidual{&curve, i}),
                                 nullptr, u.data());
      }
      if (!held.empty()) problem.SetManifold(u.data(), new ceres::SubsetManifold(3, held));
      ceres::Solver::Options options;
      options.linear_solver_type = ceres::DENSE_QR;
      options.logging_type = ceres::SILENT;
      options.function_tolerance = 1e-16;
      options.gradient_tolerance = 1e-13;
      options.max_num_iterations = 500;
      ceres::Solver::Summary summary;
      ceres::Solve(options, &problem, &summary);
    }
    const bool within = (u.array() >= low.array() - 1e-12).all() && (u.array() <= high.array() + 1e-12).all();
    const double cost = curve.Evaluate(u, nullptr, nullptr);
    if (!within || !(cost < least)) continue;
    least = cost;
    best = u;
  }
  return best;
}

class EveryEngine : public testing::TestWithParam<bool> {};

TEST_P(EveryEngine, FindsTheMinimumOfCeresWithinEveryBox) {
  const Eigen::Vector3d far(100, 100, 100), start(1, -0.5, 0.2);
  const std::pair<Eigen::Vector3d, Eigen::Vector3d> boxes[] = {
      {-far, far},
      {Eigen::Vector3d(-100, -100, 0), far},                       // c at its bound
      {Eigen::Vector3d(-100, -0.6, -100), far},                    // b at its bound
      {Eigen::Vector3d(0, -0.6, 0), Eigen::Vector3d(1, 100, 5)},   // all at bounds
      {Eigen::Vector3d(0, -2, 0.2), Eigen::Vector3d(9, 0, 0.3)}};  // the start stands on one
  DescentOptions options;
  options.use_ceres = GetParam();
  options.function_tolerance = 1e-15;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Curve3 curve(seed);
    for (const auto& [low, high] : boxes) {
      const BoundedObjective objective = curve.Within(low, high);
      const Descent descent = Descend(objective, start, options);
      const Eigen::Vector3d expected = SolvedByCeres(curve, start, low, high);
      EXPECT_TRUE(descent.converged) << descent.message;
      EXPECT_LT((descent.u - expected).norm(), 1e-5) << low.transpose() << " " << high.transpose();
      EXPECT_LE(descent.cost, curve.Evaluate(expected, nullptr, nullptr) * (1 + 1e-10));
      // The cost, gradient and matrix are those at the point returned.
      Eigen::MatrixXd gram;
      Eigen::VectorXd gradient;
      EXPECT_EQ(descent.cost, curve.Evaluate(descent.u, &gram, &gradient));
      EXPECT_EQ(descent.gradient, gradient);
      EXPECT_EQ(descent.gram, gram);
      for (Eigen::Index k = 0; k < 3; ++k)
        EXPECT_LT(GainOf(objective, descent.u, descent.cost, gram, gradient, k), 1e-4);
    }
  }
}

TEST_P(EveryEngine, TooFewStepsAreNotConverged) {
  const Curve3 curve(1);
  const Eigen::Vector3d far(100, 100, 100);
  DescentOptions options;
  options.use_ceres = GetParam();
  options.max_iterations = 1;
  const Descent descent = Descend(curve.Within(-far, far), Eigen::Vector3d(30, 0.5, -20), options);
  EXPECT_FALSE(descent.converged);
  EXPECT_EQ(descent.cost, curve.Evaluate(descent.u, nullptr, nullptr));
}

TEST_P(EveryEngine, AStartWithoutAFiniteCostIsTheWorst) {
  BoundedObjective objective;
  objective.low = Eigen::VectorXd::Constant(1, -1);
  objective.high = Eigen::VectorXd::Constant(1, 1);
  objective.evaluate = [](const Eigen::VectorXd&, Eigen::MatrixXd* gram, Eigen::VectorXd* gradient) {
    if (gram != nullptr) {
      gram->setIdentity(1, 1);
      gradient->setZero(1);
    }
    return std::nan("");
  };
  DescentOptions options;
  options.use_ceres = GetParam();
  const Descent descent = Descend(objective, Eigen::VectorXd::Zero(1), options);
  EXPECT_FALSE(descent.converged);
  EXPECT_GT(descent.cost, 1e300);
}

// (u - 3)^2 + |u|'s kink: a cost whose derivative at 0 promises what the cost does not keep.
TEST_P(EveryEngine, AKinkIsAMinimumWhereTheCostRisesOnBothSides) {
  BoundedObjective objective;
  objective.low = Eigen::VectorXd::Constant(1, -1);
  objective.high = Eigen::VectorXd::Constant(1, 1);
  objective.residuals = 100;
  objective.evaluate = [](const Eigen::VectorXd& u, Eigen::MatrixXd* gram, Eigen::VectorXd* gradient) {
    const double r = 1 + std::fabs(u(0));
    if (gram != nullptr) {
      gram->setConstant(1, 1, 1);
      gradient->setConstant(1, u(0) < 0 ? -r : r);
    }
    return r * r / 2;
  };
  DescentOptions options;
  options.use_ceres = GetParam();
  const Descent descent = Descend(objective, Eigen::VectorXd::Constant(1, 0.7), options);
  EXPECT_TRUE(descent.converged) << descent.u << " " << descent.cost;
  EXPECT_NEAR(descent.u(0), 0, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(PlainAndCeres, EveryEngine, testing::Bool());

// One small decrease under strong damping is no end: a bent valley that takes many steps.
TEST(Descend, GoesOnThroughABentValley) {
  BoundedObjective objective;
  objective.low = Eigen::VectorXd::Constant(2, -5);
  objective.high = Eigen::VectorXd::Constant(2, 5);
  objective.residuals = 2;
  objective.evaluate = [](const Eigen::VectorXd& u, Eigen::MatrixXd* gram, Eigen::VectorXd* gradient) {
    const Eigen::Vector2d r(100 * (u(1) - u(0) * u(0)), 1 - u(0));
    if (gram != nullptr) {
      Eigen::Matrix2d j;
      j << -200 * u(0), 100, -1, 0;
      *gram = j.transpose() * j;
      *gradient = j.transpose() * r;
    }
    return r.squaredNorm() / 2;
  };
  const Descent descent = Descend(objective, Eigen::Vector2d(-1.2, 1), {});
  EXPECT_TRUE(descent.converged);
  EXPECT_LT((descent.u - Eigen::Vector2d(1, 1)).norm(), 1e-6);
}

// A valley whose floor is a bent kink, x = y^2 / 50, that falls towards y = 2.
BoundedObjective BentKink() {
  BoundedObjective objective;
  objective.low = Eigen::VectorXd::Constant(2, -5);
  objective.high = Eigen::VectorXd::Constant(2, 5);
  objective.residuals = 1000;
  objective.evaluate = [](const Eigen::VectorXd& u, Eigen::MatrixXd* gram, Eigen::VectorXd* gradient) {
    const double off = u(0) - 0.02 * u(1) * u(1), side = off < 0 ? -1 : 1;
    const Eigen::Vector2d r(10 + 30 * std::fabs(off), u(1) - 2);
    if (gram != nullptr) {
      Eigen::Matrix2d j;
      j << 30 * side, -1.2 * side * u(1), 0, 1;
      *gram = j.transpose() * j;
      *gradient = j.transpose() * r;
    }
    return r.squaredNorm() / 2;
  };
  return objective;
}

TEST(Descend, GoesAlongAKink) {
  const BoundedObjective objective = BentKink();
  DescentOptions options;
  const Eigen::Vector2d start(0.5, -1);
  const double crept = std::fabs(Descend(objective, start, options).u(1) - 2);
  EXPECT_GT(crept, 1) << "plain steps";
  options.along_kinks = true;
  const Descent descent = Descend(objective, start, options);
  EXPECT_TRUE(descent.converged);
  EXPECT_LT(std::fabs(descent.u(1) - 2), 0.3 * crept);
  EXPECT_NEAR(descent.u(0), 0.02 * descent.u(1) * descent.u(1), 1e-3);
}

// Of two planes that cross at x = 1 the step ends there, at the minimum of both along the crossing.
TEST(StepAlongKink, EndsWhereBothModelsAreEqual) {
  const Eigen::Matrix2d gram = Eigen::Vector2d(0.1, 1).asDiagonal();
  const CostModel here = {Eigen::Vector2d(0, 0), 2, gram, Eigen::Vector2d(-1, -1)},
                  there = {Eigen::Vector2d(3, 1), 4.5, gram, Eigen::Vector2d(1.5, 0)};
  EXPECT_TRUE(IsBeyondKink(here, there));
  EXPECT_FALSE(IsBeyondKink(here, {there.at, 0, gram, Eigen::Vector2d(-1, 0)}));
  const Eigen::VectorXd far = Eigen::VectorXd::Constant(2, 100);
  const Eigen::VectorXd end = here.at + StepAlongKink(here, there, Eigen::VectorXd::Zero(2), -far, far);
  EXPECT_NEAR(here.cost + here.Change(end), there.cost + there.Change(end), 0.02);
  EXPECT_NEAR(end(1), 1, 1e-6);
}

// Catches a coordinate that is held at a bound although the cost falls inwards.
TEST(IsMinimum, SeesAnInwardGradientAtABoundAndNamesABetterPoint) {
  const Curve3 curve(2);
  const BoundedObjective objective = curve.Within(Eigen::Vector3d(0, -2, -1), Eigen::Vector3d(3, 0, 0.5));
  const Descent descent = Descend(objective, Eigen::Vector3d(1, -0.5, 0), {});
  ASSERT_TRUE(descent.converged);
  Eigen::VectorXd at = descent.u;
  at(2) = 0.5;  // a bound, and the cost falls inwards
  Eigen::MatrixXd gram;
  Eigen::VectorXd gradient, better;
  const double cost = objective.evaluate(at, &gram, &gradient);
  ASSERT_GT(gradient(2), 0);
  EXPECT_FALSE(IsHeld(objective, at, gradient, 2));
  EXPECT_FALSE(IsMinimum(objective, at, cost, gram, gradient, 1e-12, &better));
  EXPECT_LT(objective.evaluate(better, nullptr, nullptr), cost);
}

TEST(BoundedStep, IsTheMinimumOfTheQuadraticWithinTheBox) {
  Eigen::Matrix2d h;
  h << 2, 1, 1, 3;
  const Eigen::Vector2d g(-4, -1), far(100, 100);
  EXPECT_LT((BoundedStep(h, g, -far, far) + h.inverse() * g).norm(), 1e-12);
  // x_0 stops at 1: x_1 = (1 - 1) / 3.
  const Eigen::VectorXd held = BoundedStep(h, g, -far, Eigen::Vector2d(1, 100));
  EXPECT_NEAR(held(0), 1, 1e-15);
  EXPECT_NEAR(held(1), 0, 1e-15);
  // Without curvature a coordinate stays.
  h << 2, 0, 0, 0;
  EXPECT_EQ(BoundedStep(h, g, -far, far)(1), 0);
}

// Of coordinates that are all but proportional, several leave their bounds at once and some come back: the conditions
// of Karush, Kuhn and Tucker hold at the end all the same, and the step goes down.
TEST(BoundedStep, CoordinatesComeBackFromTheirBounds) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  constexpr Eigen::Index kSize = 12;
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::MatrixXd rows =
        Eigen::MatrixXd::NullaryExpr(14, kSize, [&] { return normal(random); }) +
        Eigen::VectorXd::NullaryExpr(14, [&] { return 5 * normal(random); }) * Eigen::RowVectorXd::Ones(kSize);
    const Eigen::MatrixXd h = rows.transpose() * rows;
    const Eigen::VectorXd g = Eigen::VectorXd::NullaryExpr(kSize, [&] { return 10 * normal(random); });
    Eigen::VectorXd low(kSize), high(kSize);
    for (Eigen::Index i = 0; i < kSize; ++i) {
      low(i) = uniform(random) < 0.3 ? 0 : -uniform(random);
      high(i) = uniform(random) < 0.3 ? 0 : uniform(random);
    }
    const Eigen::VectorXd x = BoundedStep(h, g, low, high), slope = h * x + g;
    EXPECT_LE(0.5 * x.dot(h * x) + g.dot(x), 0) << trial;
    for (Eigen::Index i = 0; i < kSize; ++i) {
      ASSERT_GE(x(i), low(i)) << trial;
      ASSERT_LE(x(i), high(i)) << trial;
      if (low(i) == high(i)) continue;
      if (x(i) > low(i)) {
        EXPECT_LE(slope(i), 1e-8 * g.norm()) << trial << " " << i;
      }
      if (x(i) < high(i)) {
        EXPECT_GE(slope(i), -1e-8 * g.norm()) << trial << " " << i;
      }
    }
  }
}

}  // namespace
}  // namespace lobefit
