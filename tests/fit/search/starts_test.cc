#include "lobefit/fit/search/starts.h"

#include <set>

#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

namespace lobefit {
namespace {

TEST(StratifiedSubsample, TakesOneFromEachRunAndIsReproducible) {
  const std::vector<std::size_t> a = StratifiedSubsample(10000, 100, 7);
  EXPECT_EQ(a, StratifiedSubsample(10000, 100, 7));
  EXPECT_NE(a, StratifiedSubsample(10000, 100, 8));
  ASSERT_EQ(a.size(), 100U);
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k] / 100, k);
  EXPECT_EQ(StratifiedSubsample(5, 100, 7), (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(StepLinear, IsExactInOneStepWhereTheMetricIsQuadratic) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0);
  Measurement measurement = Synthetic(truth, StandardLayout(), 0, 1);
  for (const Metric metric : {Metric::kCosineL2, Metric::kRelative, Metric::kNgan}) {
    Recipe recipe = DefaultRecipe(truth.model, "test");
    recipe.metric = metric;
    const Layout layout(recipe, measurement.channels.names);
    const Problem problem(measurement.samples, recipe);
    ThreadPool pool(1);
    std::vector<double> u = layout.FromShapes({{0.2, 0.2, 0, 0, 0}});
    const double before = problem.Sum(layout.ToKernel(u.data()), false, &pool).sum_rho / 2;
    EXPECT_DOUBLE_EQ(StepLinear(problem, layout, &u, &pool), before);
    EXPECT_LT(problem.Sum(layout.ToKernel(u.data()), false, &pool).sum_rho / 2, 1e-20);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(u[1 + c], truth.values[5][c], 1e-10);
      EXPECT_NEAR(u[4 + c], truth.values[6][c], 1e-10);
    }
  }
}

TEST(StepLinear, StaysWithinTheBounds) {
  // A truth whose f0 is far above 1: the best amplitude within the bounds is 1.
  SyntheticCase truth = OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0, {3, 3, 3}, {0.1, 0.1, 0.1});
  Measurement measurement = Synthetic(truth, StandardLayout(), 0, 1);
  Recipe recipe = DefaultRecipe(truth.model, "test");
  recipe.metric = Metric::kCosineL2;
  const Layout layout(recipe, measurement.channels.names);
  ThreadPool pool(1);
  std::vector<double> u = layout.FromShapes({{0.2, 0.2, 0, 0, 0}});
  StepLinear(Problem(measurement.samples, recipe), layout, &u, &pool);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(u[1 + c], 1.0);
}

TEST(RankedStarts, TheBestCandidateIsTheNearestShape) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.085, 0.085, 0, 0, 0);
  Measurement measurement = Synthetic(truth, StandardLayout(), 0, 1);
  const Recipe recipe = DefaultRecipe(truth.model, "test");
  const Layout layout(recipe, measurement.channels.names);
  ThreadPool pool(2);
  const std::vector<Start> starts =
      RankedStarts(Problem(measurement.samples, recipe), layout, measurement.samples, &pool);
  EXPECT_NEAR(std::exp(starts[0].u[0]), 0.08, 1e-12);
  EXPECT_TRUE(
      std::is_sorted(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.cost < b.cost; }));
}

}  // namespace
}  // namespace lobefit
