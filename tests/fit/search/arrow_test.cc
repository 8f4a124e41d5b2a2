// Steps and fits of many channels through the arrow, against the dense matrix.
#include "lobefit/fit/coordinates/arrow.h"

#include <cmath>
#include <random>

#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/fit/search/search.h"
#include "lobefit/fit/search/solve.h"

namespace lobefit {
namespace {

// Positive definite, with `border` coordinates and `own` ones in each channel, numbered at random.
ArrowMatrix RandomArrow(std::size_t border, std::size_t channels, std::size_t own, std::mt19937_64* random) {
  std::vector<int> names(border + channels * own);
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = static_cast<int>(i);
  std::shuffle(names.begin(), names.end(), *random);
  ArrowShape shape;
  shape.border.assign(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(border));
  for (std::size_t c = 0; c < channels; ++c) {
    const auto first = names.begin() + static_cast<std::ptrdiff_t>(border + c * own);
    shape.own.emplace_back(first, first + static_cast<std::ptrdiff_t>(own));
  }
  ArrowMatrix arrow(shape);
  std::normal_distribution<double> normal;
  const auto rows = static_cast<Eigen::Index>(own + border + 2);
  for (std::size_t c = 0; c < std::max<std::size_t>(channels, 1); ++c) {
    const Eigen::MatrixXd b = Eigen::MatrixXd::NullaryExpr(rows, static_cast<Eigen::Index>(border),
                                                           [&](Eigen::Index, Eigen::Index) { return normal(*random); });
    arrow.border += b.transpose() * b;
    if (channels == 0) break;
    const Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(rows, static_cast<Eigen::Index>(own),
                                                           [&](Eigen::Index, Eigen::Index) { return normal(*random); });
    arrow.across[c] = b.transpose() * a;
    arrow.own[c] = a.transpose() * a;
  }
  return arrow;
}

TEST(ArrowStep, IsThatOfTheDenseMatrix) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t border = random() % 4, channels = border == 0 ? 1 + random() % 5 : random() % 6,
                      own = random() % 3 + (border == 0 ? 1 : 0);
    ArrowMatrix arrow = RandomArrow(border, channels, own, &random);
    const Eigen::Index n = arrow.Diagonal().size();
    if (trial % 5 == 0) {
      // Nothing depends on this one.
      const auto k = static_cast<std::size_t>(random() % 2);
      if (own > 0 && channels > k)
        arrow.own[k].row(0).setZero(), arrow.own[k].col(0).setZero(), arrow.across[k].col(0).setZero();
    }
    const Eigen::MatrixXd dense = arrow.Dense();
    EXPECT_EQ(dense, dense.transpose());
    EXPECT_EQ(dense.diagonal(), arrow.Diagonal());
    Eigen::VectorXd gradient(n), low(n), high(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      gradient(i) = 3 * normal(random);
      low(i) = -uniform(random) * (trial % 3 == 0 ? 100 : 0.5);
      high(i) = uniform(random) * (trial % 3 == 0 ? 100 : 0.5);
    }
    const Eigen::VectorXd a = BoundedStep(arrow, gradient, low, high), b = BoundedStep(dense, gradient, low, high);
    EXPECT_LT((a - b).lpNorm<Eigen::Infinity>(), 1e-8 * (1 + b.lpNorm<Eigen::Infinity>())) << trial;
    EXPECT_GE((a - low).minCoeff(), 0);
    EXPECT_GE((high - a).minCoeff(), 0);
  }
}

TEST(ArrowStep, LeavesACoordinateWithoutRoomWhereItIs) {
  std::mt19937_64 random(4);
  const ArrowMatrix arrow = RandomArrow(2, 3, 2, &random);
  const Eigen::VectorXd gradient = Eigen::VectorXd::Ones(8);
  Eigen::VectorXd low = Eigen::VectorXd::Constant(8, -100), high = Eigen::VectorXd::Constant(8, 100);
  low(2) = high(2) = 0;
  low(5) = high(5) = 0.25;
  const Eigen::VectorXd x = BoundedStep(arrow, gradient, low, high);
  EXPECT_EQ(x(2), 0);
  EXPECT_EQ(x(5), 0.25);
  // The others are where the gradient of the quadratic vanishes.
  const Eigen::VectorXd slope = arrow.Dense() * x + gradient;
  for (Eigen::Index i = 0; i < 8; ++i) {
    if (i != 2 && i != 5) {
      EXPECT_NEAR(slope(i), 0, 1e-9);
    }
  }
}

struct Spectral {
  explicit Spectral(std::size_t channels, bool shared = false) {
    std::vector<double> f0, diffuse;
    for (std::size_t c = 0; c < channels; ++c) {
      const double x = static_cast<double>(c) / static_cast<double>(channels);
      f0.push_back(shared ? 0.5 : 0.3 + 0.4 * x);
      diffuse.push_back(c % 5 == 0 ? 0.0 : 0.2 - 0.15 * x);  // some at their bound
    }
    truth = OneLobe(Ndf::kEllipsoid, 0.4, 0.2, 2, 3, 25, f0, diffuse);
    for (std::size_t c = 0; c < channels; ++c) truth.channels[c] = std::to_string(400 + c);
    GoniometerLayout goniometer = StandardLayout();
    goniometer.polar_angles = {DegreesToRadians(20), DegreesToRadians(50)};
    goniometer.detector_step = DegreesToRadians(25);
    measurement = Synthetic(truth, goniometer, 0.03, 1);
    recipe = DefaultRecipe(truth.model, "spectral");
    recipe.parameters[5].shared = shared;
  }
  SyntheticCase truth;
  Measurement measurement;
  Recipe recipe;
};

TEST(Arrow, IsTheGaussNewtonMatrix) {
  for (const bool shared : {false, true}) {
    const Spectral spectral(7, shared);
    const Layout layout(spectral.recipe, spectral.measurement.channels.names);
    const Problem problem(spectral.measurement.samples, spectral.recipe);
    ThreadPool pool(1);
    std::vector<double> u = layout.FromShapes({{0.4, 0.2, 0.03, 0.05, 0.4}});
    Eigen::MatrixXd dense;
    Eigen::VectorXd gradient, of_arrow;
    ArrowMatrix arrow;
    const double cost = Linearise(problem, layout, u.data(), &pool, &dense, &gradient);
    EXPECT_EQ(Linearise(problem, layout, u.data(), &pool, &arrow, &of_arrow), cost);
    EXPECT_EQ(arrow.Dense(), dense);
    EXPECT_EQ(of_arrow, gradient);
    EXPECT_EQ(arrow.shape.border.size(), shared ? 6U : 5U) << "a shared value belongs to the border";
  }
}

// A whole search of 40 channels, against descents by Ceres on the dense matrix.
TEST(Arrow, FindsTheMinimumOfTheDenseDescent) {
  const Spectral spectral(40);
  const Layout layout(spectral.recipe, spectral.measurement.channels.names);
  ASSERT_GE(layout.size(), kManyCoordinates);
  const Problem problem(spectral.measurement.samples, spectral.recipe);
  ThreadPool pool(1);
  const std::vector<DistinctMinimum> minima = FindMinima(problem, layout, spectral.measurement.samples, {}, &pool);
  const Solution& found = minima.at(0).solution;
  EXPECT_TRUE(found.converged);
  BoundedObjective dense = ObjectiveOf(problem, layout, &pool);
  ASSERT_TRUE(dense.evaluate_arrow);
  dense.evaluate_arrow = nullptr;
  DescentOptions options;
  options.use_ceres = true;
  const Eigen::Map<const Eigen::VectorXd> u(found.u.data(), static_cast<Eigen::Index>(found.u.size()));
  const std::vector<double> start = layout.FromShapes({{0.35, 0.25, 0, 0, 0.3}});
  const Descent descent =
      Descend(dense, Eigen::Map<const Eigen::VectorXd>(start.data(), static_cast<Eigen::Index>(start.size())), options);
  EXPECT_TRUE(descent.converged);
  EXPECT_NEAR(found.cost / descent.cost, 1, 1e-9);
  const Eigen::VectorXd errors = descent.gram.diagonal().cwiseSqrt().cwiseInverse() *
                                 std::sqrt(2 * descent.cost / static_cast<double>(dense.residuals));
  EXPECT_LT((u - descent.u).cwiseQuotient(errors).lpNorm<Eigen::Infinity>(), 0.02) << "standard errors";
  std::size_t at_bound = 0;
  for (std::size_t c = 0; c < 40; ++c)
    at_bound += found.u[static_cast<std::size_t>(layout.linear(c)[1].index)] == 0 ? 1 : 0;
  EXPECT_GT(at_bound, 1U) << "bounds are met";
}

}  // namespace
}  // namespace lobefit
