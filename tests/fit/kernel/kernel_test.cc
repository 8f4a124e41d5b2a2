#include "lobefit/fit/kernel/kernel.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/support/jet_model.h"
#include "tests/support/synthetic.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/solve.h"

namespace lobefit {
namespace {

constexpr int kCoordinates = 5 + 6;
using KernelJet = ceres::Jet<double, kCoordinates>;

class EveryMetric : public testing::TestWithParam<Metric> {};

TEST_P(EveryMetric, SumsAgreeWithJets) {
  Recipe recipe = DefaultRecipe({{Lobe{}}, Diffuse::kLambert}, "test");
  recipe.metric = GetParam();
  recipe.noise = {0.01, 0.05};
  // 0 tilt would leave every sample on one side of the clamp; 4 and -2 degrees give both.
  Measurement measurement = Synthetic(OneLobe(Ndf::kEllipsoid, 0.3, 0.12, 4, -2, 20), StandardLayout(), 0.2, 5);
  SetAsideForRecipe(recipe, &measurement);
  const Samples& samples = measurement.samples;
  const Layout layout(recipe, measurement.channels.names);
  ASSERT_EQ(layout.size(), static_cast<std::size_t>(kCoordinates));
  const Problem problem(samples, recipe);
  std::vector<double> u = layout.FromShapes({{0.4, 0.2, 0.05, 0.03, 0.2}});
  for (std::size_t i = 5; i < 8; ++i) u[i] = 0.3 + 0.1 * static_cast<double>(i - 5);
  for (std::size_t i = 8; i < 11; ++i) u[i] = 0.2 - 0.05 * static_cast<double>(i - 8);

  Eigen::Matrix<double, kCoordinates, kCoordinates> expected_h =
      Eigen::Matrix<double, kCoordinates, kCoordinates>::Zero();
  Eigen::Matrix<double, kCoordinates, 1> expected_g = Eigen::Matrix<double, kCoordinates, 1>::Zero();
  double expected_cost = 0;
  KernelJet jets[kCoordinates];
  for (int k = 0; k < kCoordinates; ++k) jets[k] = KernelJet(u[static_cast<std::size_t>(k)], k);
  double sum_weight = 0;
  std::vector<double> weight(samples.size(), 1.0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double sin_i = std::sqrt(1 - samples.wi_z[i] * samples.wi_z[i]),
                 sin_o = std::sqrt(std::max(0.0, 1 - samples.wo_z[i] * samples.wo_z[i]));
    if (GetParam() == Metric::kNgan) weight[i] = sin_i * sin_o;
    if (GetParam() == Metric::kLowLog) weight[i] = sin_i;
    sum_weight += weight[i];
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double w = weight[i] * static_cast<double>(samples.size()) / sum_weight;
    for (std::size_t c = 0; c < 3; ++c) {
      const KernelJet r =
          JetResidual(TransformOf(GetParam(), recipe.noise), JetModelValue(jets, c, samples.wi(i), samples.wo(i)),
                      samples.values[c][i], samples.wi(i));
      expected_cost += 0.5 * w * r.a * r.a;
      expected_g += w * r.a * r.v;
      expected_h += w * r.v * r.v.transpose();
    }
  }
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  ThreadPool pool(2);
  const double cost = Linearise(problem, layout, u.data(), &pool, &hessian, &gradient);
  EXPECT_NEAR(cost, expected_cost, 1e-11 * expected_cost);
  EXPECT_LT((hessian - expected_h).norm(), 1e-10 * expected_h.norm());
  EXPECT_LT((gradient - expected_g).norm(), 1e-10 * expected_g.norm());
  // The cost is the same number with and without derivatives.
  EXPECT_EQ(problem.Sum(layout.ToKernel(u.data()), false, &pool).sum_rho / 2, cost);
}

INSTANTIATE_TEST_SUITE_P(All, EveryMetric,
                         testing::Values(Metric::kLog, Metric::kCubeRoot, Metric::kRelative, Metric::kCosineL2,
                                         Metric::kNgan, Metric::kLowLog, Metric::kAsinh));

TEST(Kernel, SameBitsOnOneAndEightThreads) {
  Recipe recipe = DefaultRecipe({{Lobe{}}, Diffuse::kLambert}, "test");
  GoniometerLayout goniometer = StandardLayout();
  goniometer.detector_step = DegreesToRadians(6);
  const Measurement measurement = Synthetic(OneLobe(Ndf::kEllipsoid, 0.3, 0.12, 4, -2, 20), goniometer, 0.2, 5);
  const Layout layout(recipe, measurement.channels.names);
  const Problem problem(measurement.samples, recipe);
  const std::vector<double> u = layout.FromShapes({{0.4, 0.2, 0.05, 0.03, 0.2}});
  Eigen::MatrixXd h1, h8;
  Eigen::VectorXd g1, g8;
  ThreadPool one(1), eight(8);
  const double c1 = Linearise(problem, layout, u.data(), &one, &h1, &g1);
  const double c8 = Linearise(problem, layout, u.data(), &eight, &h8, &g8);
  EXPECT_EQ(c1, c8);
  EXPECT_TRUE(h1 == h8);
  EXPECT_TRUE(g1 == g8);
}

// Derivative of the cost by coordinate k, by central differences.
double SlopeOfCost(const Problem& problem, const Layout& layout, std::vector<double> u, std::size_t k,
                   ThreadPool* pool) {
  constexpr double kStep = 1e-6;
  const double at = u[k];
  u[k] = at + kStep;
  const double up = problem.Sum(layout.ToKernel(u.data()), false, pool).sum_rho;
  u[k] = at - kStep;
  return (up - problem.Sum(layout.ToKernel(u.data()), false, pool).sum_rho) / (4 * kStep);
}

TEST(Kernel, LossesWeighASampleOverItsChannels) {
  Recipe recipe = DefaultRecipe({{Lobe{}}, Diffuse::kLambert}, "test");
  const Measurement measurement = Synthetic(OneLobe(Ndf::kEllipsoid, 0.3, 0.12, 4, -2, 20), StandardLayout(), 0.2, 5);
  ThreadPool pool(1);
  for (const Loss loss : {Loss::kHuber, Loss::kCauchy, Loss::kTukey}) {
    recipe.loss = loss;
    recipe.loss_scale = 0.05;
    const Layout layout(recipe, measurement.channels.names);
    const Problem problem(measurement.samples, recipe);
    std::vector<double> u = layout.FromShapes({{0.33, 0.14, 0.05, 0.01, 0.3}});
    std::fill(u.begin() + 5, u.begin() + 8, 0.4);
    std::fill(u.begin() + 8, u.end(), 0.1);
    Eigen::MatrixXd hessian;
    Eigen::VectorXd gradient;
    Linearise(problem, layout, u.data(), &pool, &hessian, &gradient);
    // The gradient is the derivative of the cost, by central differences.
    for (std::size_t k = 0; k < u.size(); ++k) {
      const double difference = SlopeOfCost(problem, layout, u, k, &pool);
      EXPECT_NEAR(gradient(static_cast<Eigen::Index>(k)), difference, 1e-5 * gradient.norm()) << k;
    }
  }
}

// Of a coat over a lobe and a Lambertian part: the derivatives of the cost by everything, the coat's index and
// absorption too.
TEST(Kernel, CoatsMoveAllThatLiesBelow) {
  ThreadPool pool(1);
  const Measurement measurement = Synthetic(OneLobe(Ndf::kEllipsoid, 0.3, 0.12, 4, -2, 20), StandardLayout(), 0.2, 5);
  const std::pair<Fresnel, double> cases[] = {
      {Fresnel::kCoatLayered, 0}, {Fresnel::kCoatRefracted, 0}, {Fresnel::kCoatLayered, 1.5}};
  for (const auto& [coat, detector_deg] : cases) {
    // The masking of a tilted lobe has kinks, which the mean over a disc brings to every sample.
    const Ndf base = detector_deg > 0 ? Ndf::kGgxAnisotropic : Ndf::kEllipsoid;
    Recipe recipe = DefaultRecipe({{{base}, {Ndf::kGgx, Masking::kSmithSeparable, coat}}, Diffuse::kLambert}, "coated");
    recipe.parameters[FirstFresnel(recipe.model, 1) + 1].free = true;  // tau
    recipe.instrument.detector = DegreesToRadians(detector_deg);
    const Layout layout(recipe, measurement.channels.names);
    const std::size_t shape = detector_deg > 0 ? 4 : 6;
    ASSERT_EQ(layout.size(), shape + 3U + 1U + 3U + 3U);
    const Problem problem(measurement.samples, recipe);
    std::vector<double> u = layout.FromShapes({{0.33, 0.14, 0.05, 0.01, 0.3}, {0.08, 0.08, 0, 0, 0}});
    const double linear[] = {0.4, 0.5, 0.6, 1.6, 0.1, 0.2, 0.3, 0.3, 0.2, 0.1};
    std::copy(std::begin(linear), std::end(linear), u.begin() + static_cast<std::ptrdiff_t>(shape));
    Eigen::MatrixXd hessian;
    Eigen::VectorXd gradient;
    Linearise(problem, layout, u.data(), &pool, &hessian, &gradient);
    for (std::size_t k = 0; k < u.size(); ++k) {
      const double difference = SlopeOfCost(problem, layout, u, k, &pool);
      EXPECT_NEAR(gradient(static_cast<Eigen::Index>(k)), difference, 1e-7 * gradient.norm())
          << layout.coordinates()[k].name;
      EXPECT_GT(std::fabs(difference), 1e-4 * gradient.norm()) << layout.coordinates()[k].name;
    }
    if (detector_deg > 0) continue;
    // The stream of the fit and the evaluation of reports are one model.
    std::vector<std::vector<double>> values;
    ModelValues(problem.kernel_samples(), layout.ToKernel(u.data()), 0, problem.size(), &values);
    const Reflectance reflectance(recipe.model, layout.Report(u.data()), 3);
    for (std::size_t i = 0; i < problem.size(); i += 17) {
      double f[3];
      reflectance.Evaluate(measurement.samples.wi(i), measurement.samples.wo(i), f);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(values[c][i], f[c], 1e-11 * f[c]);
    }
  }
}

TEST(Kernel, APerfectModelHasResidualsOfExactlyZero) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.3, 0.12, 4, -2, 20);
  Recipe recipe = DefaultRecipe(truth.model, "test");
  Measurement measurement = Synthetic(truth, StandardLayout(), 0, 1);
  const Layout layout(recipe, measurement.channels.names);
  std::vector<double> u =
      layout.FromShapes({{0.3, 0.12, DegreesToRadians(4), DegreesToRadians(-2), DegreesToRadians(20)}});
  std::copy(truth.values[5].begin(), truth.values[5].end(), u.begin() + 5);
  std::copy(truth.values[6].begin(), truth.values[6].end(), u.begin() + 8);
  const Problem problem(measurement.samples, recipe);
  ThreadPool pool(1);
  EXPECT_LT(problem.Sum(layout.ToKernel(u.data()), false, &pool).sum_rho, 1e-28 * static_cast<double>(problem.size()));
}

}  // namespace
}  // namespace lobefit
