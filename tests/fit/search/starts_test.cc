#include "lobefit/fit/search/starts.h"

#include <cmath>

#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/fit/search/solve.h"

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
      RankedStarts(Problem(measurement.samples, recipe), layout, measurement.samples, 8, &pool);
  EXPECT_NEAR(std::exp(starts[0].u[0]), 0.08, 1e-12);
  EXPECT_TRUE(
      std::is_sorted(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.cost < b.cost; }));
}

// A spectrum of `count` channels, no two alike.
SyntheticCase Spectrum(std::size_t count) {
  std::vector<double> f0, diffuse;
  for (std::size_t c = 0; c < count; ++c) {
    f0.push_back(0.3 + 0.4 * static_cast<double>(c) / static_cast<double>(count));
    diffuse.push_back(0.1 + 0.05 * std::sin(0.3 * static_cast<double>(c)));
  }
  return OneLobe(Ndf::kEllipsoid, 0.25, 0.1, 3, -5, 20, f0, diffuse);
}

TEST(RankedStarts, OfManyChannelsTheBestAreThoseOfAllCandidates) {
  const SyntheticCase truth = Spectrum(100);
  Measurement measurement = Synthetic(truth, StandardLayout(), 0.05, 1);
  Recipe recipe = DefaultRecipe(truth.model, "test");
  // One value a channel: those of the channels that rank are taken.
  recipe.parameters[5].start = truth.values[5];
  const Layout layout(recipe, measurement.channels.names);
  const Problem problem(measurement.samples, recipe);
  ThreadPool pool(2);
  constexpr std::size_t kWanted = 8, kEvery = 1000;
  const std::vector<Start> some = RankedStarts(problem, layout, measurement.samples, kWanted, &pool),
                           all = RankedStarts(problem, layout, measurement.samples, kEvery, &pool);
  EXPECT_LT(some.size(), all.size() / 2);
  for (std::size_t k = 0; k < kWanted; ++k) {
    EXPECT_EQ(some[k].u, all[k].u) << k;
    EXPECT_EQ(some[k].cost, all[k].cost) << k;
  }
}

TEST(DropShapes, LeavesTheSumsOfAmplitudes) {
  const SyntheticCase truth = Spectrum(5);
  Measurement measurement = Synthetic(truth, StandardLayout(), 0.05, 1);
  const Recipe recipe = DefaultRecipe(truth.model, "test");
  const Layout layout(recipe, measurement.channels.names);
  const Problem problem(measurement.samples, recipe);
  ThreadPool pool(1);
  const std::vector<double> u = layout.FromShapes({{0.3, 0.2, 0, 0, 0}});
  ArrowMatrix whole, dropped;
  Eigen::VectorXd gradient, gradient_dropped;
  Linearise(problem, layout, u.data(), &pool, &whole, &gradient);
  KernelModel kernel = layout.ToKernel(u.data());
  const std::size_t columns = layout.DropShapes(&kernel);
  EXPECT_EQ(columns, layout.shape_size());
  layout.Gather(problem.Sum(kernel, true, &pool), &dropped, &gradient_dropped, columns);
  const auto shapes = static_cast<Eigen::Index>(columns), linear = gradient.size() - shapes;
  EXPECT_EQ(gradient_dropped.tail(linear), gradient.tail(linear));
  EXPECT_TRUE(gradient_dropped.head(shapes).isZero(0));
  for (std::size_t c = 0; c < whole.own.size(); ++c) EXPECT_EQ(dropped.own[c], whole.own[c]);
}

}  // namespace
}  // namespace lobefit
