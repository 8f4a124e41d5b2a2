#include "lobefit/fit/search/distinct.h"

#include <cmath>

#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/core/ellipsoid/ellipsoid_symmetry.h"
#include "lobefit/fit/search/search.h"

namespace lobefit {
namespace {

// A measurement, a recipe for it and points where descents are said to have ended, all at the cost of the first.
struct Ends {
  Ends(const SyntheticCase& truth, const GoniometerLayout& goniometer, const Recipe& recipe)
      : measurement(Synthetic(truth, goniometer, 0.05, 1)),
        layout(recipe, measurement.channels.names),
        problem(measurement.samples, recipe),
        pool(1) {}

  void Add(const std::vector<double>& u) {
    DistinctMinimum minimum;
    minimum.solution.u = u;
    minimum.solution.cost =
        minima.empty() ? problem.Sum(layout.ToKernel(u.data()), false, &pool).sum_rho / 2 : minima[0].solution.cost;
    minima.push_back(minimum);
  }
  std::size_t Joined() {
    JoinFoundAgain(problem, layout, &pool, &minima);
    std::size_t starts = 0;
    for (const DistinctMinimum& minimum : minima) starts += minimum.starts;
    EXPECT_GE(starts, minima.size());
    return minima.size();
  }

  Measurement measurement;
  Layout layout;
  Problem problem;
  ThreadPool pool;
  std::vector<DistinctMinimum> minima;
};

GoniometerLayout InOnePlane() {
  GoniometerLayout layout = StandardLayout();
  layout.azimuths = {0};
  layout.in_plane = true;
  return layout;
}

// The search itself: a detector in the plane of incidence sees a lobe and its mirror image alike.
TEST(DistinctMinima, MirrorImagesOfEqualCostStayTwo) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.35, 0.11, 0, 3, 25);
  Ends ends(truth, InOnePlane(), DefaultRecipe(truth.model, "ellipsoid"));
  FitOptions options;
  options.starts = 20;
  const std::vector<DistinctMinimum> minima =
      FindMinima(ends.problem, ends.layout, ends.measurement.samples, options, &ends.pool);
  ASSERT_GE(minima.size(), 2U);
  EXPECT_NEAR(minima[1].solution.cost / minima[0].solution.cost, 1, 1e-6);
  const double one = ends.layout.Report(minima[0].solution.u.data())[4][0],
               other = ends.layout.Report(minima[1].solution.u.data())[4][0];
  EXPECT_NEAR(one, -other, 1e-3);
  EXPECT_GT(std::fabs(one), DegreesToRadians(15));
  EXPECT_GE(minima[0].starts + minima[1].starts, 4U) << "each is found more than once and stands in the list once";
  for (std::size_t k = 2; k < minima.size(); ++k)
    EXPECT_GT(minima[k].solution.cost, minima[0].solution.cost * (1 + 1e-5));
}

TEST(DistinctMinima, APointWithinTwoStandardErrorsIsTheSame) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.35, 0.11, 0, 3, 25);
  const std::vector<Ellipsoid> shape = {{0.35, 0.11, 0, DegreesToRadians(3), DegreesToRadians(25)}};
  Ends ends(truth, StandardLayout(), DefaultRecipe(truth.model, "ellipsoid"));
  const std::vector<double> u = ends.layout.FromShapes(shape);
  Eigen::MatrixXd gram;
  Eigen::VectorXd gradient;
  const double cost = Linearise(ends.problem, ends.layout, u.data(), &ends.pool, &gram, &gradient);
  const auto residuals = static_cast<double>(ends.problem.size() * ends.problem.channels());
  for (Eigen::Index k = 0; k < gram.rows(); ++k) {
    // Of this coordinate alone.
    const double error = std::sqrt(2 * cost / (residuals - static_cast<double>(gram.rows())) / gram(k, k));
    for (const double errors : {0.5, 1.9, -1.9, 2.1, -2.1}) {
      ends.minima.clear();
      ends.Add(u);
      std::vector<double> moved = u;
      moved[static_cast<std::size_t>(k)] += errors * error;
      ends.Add(moved);
      EXPECT_EQ(ends.Joined(), std::fabs(errors) < 2 ? 1U : 2U) << k << " " << errors;
    }
  }
}

// A descent that stopped a little above the minimum near it is not the minimum found again. Catches a tolerance of the
// costs of 1e-2 in place of 1e-5.
TEST(DistinctMinima, AnotherCostIsAnotherMinimum) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0);
  Ends ends(truth, StandardLayout(), DefaultRecipe(truth.model, "ggx"));
  const std::vector<double> u = ends.layout.FromShapes({{0.2, 0.2, 0, 0, 0}});
  const auto residuals = static_cast<double>(ends.problem.size() * ends.problem.channels());
  ASSERT_GT(residuals, 9000) << "a relative 1e-5 is a twentieth of a variance";
  for (const double relative : {0.9e-5, 1.1e-5, 1e-3}) {
    ends.minima.clear();
    ends.Add(u);
    ends.Add(u);
    ends.minima[1].solution.cost *= 1 + relative;
    EXPECT_EQ(ends.Joined(), relative < 1e-5 ? 1U : 2U) << relative;
  }
}

TEST(DistinctMinima, ExchangedLobesAreOne) {
  SyntheticCase truth = OneLobe(Ndf::kGgx, 0.1, 0.1, 0, 0, 0);
  truth.model.lobes.push_back(truth.model.lobes[0]);
  truth.values = {
      {0.1}, {0.1}, {0}, {0}, {0}, {0.5, 0.4, 0.3}, {0.4}, {0.4}, {0}, {0}, {0}, {0.2, 0.3, 0.1}, {0.1, 0.05, 0.02}};
  for (const bool bounded : {false, true}) {
    Recipe recipe = DefaultRecipe(truth.model, "two");
    if (bounded) recipe.parameters[0].high = 0.3, recipe.parameters[0].low = 0.01;
    Ends ends(truth, StandardLayout(), recipe);
    const std::vector<Ellipsoid> shapes = {{0.1, 0.1, 0, 0, 0}, {0.28, 0.28, 0, 0, 0}};
    std::vector<double> u = ends.layout.FromShapes(shapes);
    for (std::size_t c = 0; c < 3; ++c) {
      u[static_cast<std::size_t>(ends.layout.linear(c)[0].index)] = truth.values[5][c];
      u[static_cast<std::size_t>(ends.layout.linear(c)[1].index)] = truth.values[11][c];
    }
    std::vector<double> exchanged = u;
    std::swap(exchanged[0], exchanged[1]);
    for (std::size_t c = 0; c < 3; ++c) {
      std::swap(exchanged[static_cast<std::size_t>(ends.layout.linear(c)[0].index)],
                exchanged[static_cast<std::size_t>(ends.layout.linear(c)[1].index)]);
    }
    ends.Add(u);
    ends.Add(exchanged);
    EXPECT_EQ(ends.layout.AreInterchangeable(0, 1), !bounded);
    EXPECT_EQ(ends.Joined(), bounded ? 2U : 1U) << "lobes with bounds of their own are told apart by them";
  }
}

// Lobes with a bound move in angles: half a turn, and exchanged axes, are the same ellipsoid.
TEST(DistinctMinima, OneEllipsoidInOtherAnglesIsOne) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.35, 0.11, 2, 3, 89);
  Recipe recipe = DefaultRecipe(truth.model, "bounded");
  recipe.parameters[0].high = 0.9, recipe.parameters[0].low = 0.01;
  const double tx = DegreesToRadians(2), ty = DegreesToRadians(3), tz = DegreesToRadians(89);
  const Ellipsoid ellipsoid = {0.35, 0.11, tx, ty, tz};
  const Ellipsoid equal[] = {{0.35, 0.11, -tx, -ty, tz - kPi}, SwapAxes(ellipsoid), FoldAngles(SwapAxes(ellipsoid))};
  const Ellipsoid different[] = {
      {0.35, 0.11, tx, ty, tz - kPi}, {0.35, 0.11, -tx, -ty, tz}, {0.11, 0.35, tx, ty, tz}, MirrorY(ellipsoid)};
  Ends ends(truth, StandardLayout(), recipe);
  const auto point = [&](const Ellipsoid& e) {
    std::vector<double> u = ends.layout.FromShapes({ellipsoid});
    u[0] = std::log(e.alpha_x), u[1] = std::log(e.alpha_y), u[2] = e.theta_x, u[3] = e.theta_y, u[4] = e.theta_z;
    return u;
  };
  for (const Ellipsoid& other : equal) {
    ends.minima.clear();
    ends.Add(point(ellipsoid));
    ends.Add(point(other));
    EXPECT_EQ(ends.Joined(), 1U) << other.theta_z;
  }
  for (const Ellipsoid& other : different) {
    ends.minima.clear();
    ends.Add(point(ellipsoid));
    ends.Add(point(other));
    EXPECT_EQ(ends.Joined(), 2U) << other.theta_z;
  }
}

// What reflects nothing has no shape.
TEST(DistinctMinima, ALobeThatVanishedIsTheSameAtEveryWidth) {
  SyntheticCase truth = OneLobe(Ndf::kGgx, 0.1, 0.1, 0, 0, 0);
  truth.model.lobes[0].fresnel = Fresnel::kNone;
  Recipe recipe = DefaultRecipe(truth.model, "scaled");
  recipe.metric = Metric::kCosineL2;
  Ends ends(truth, StandardLayout(), recipe);
  for (const double alpha : {0.1, 0.5}) {
    std::vector<double> u = ends.layout.FromShapes({{alpha, alpha, 0, 0, 0}});
    for (std::size_t c = 0; c < 3; ++c) u[static_cast<std::size_t>(ends.layout.linear(c)[0].index)] = 0;
    ends.Add(u);
  }
  EXPECT_EQ(ends.Joined(), 1U);
}

}  // namespace
}  // namespace lobefit
