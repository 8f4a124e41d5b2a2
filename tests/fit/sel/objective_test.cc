#include "lobefit/fit/sel/objective.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "lobefit/core/sel/sel.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

SelSlice TwoLobes(std::size_t channels) {
  SelSlice slice;
  slice.lobes = {{0.2, 0.15, 0.02, 0.01, 0.4}, {0.7, 0.5, 0, 0, 1}};
  slice.amplitude.resize(2);
  for (std::size_t c = 0; c < channels; ++c) {
    const double x = static_cast<double>(c) / static_cast<double>(channels);
    slice.amplitude[0].push_back(1 + x);
    slice.amplitude[1].push_back(0.5 - 0.3 * x);
    slice.constant.push_back(0.05 + 0.02 * x);
  }
  return slice;
}

SelSamples SamplesOf(const SelSlice& truth, std::size_t count) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  SelSamples samples;
  samples.f_r.resize(truth.constant.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 v = FromSpherical(1.3 * uniform(random), 2 * kPi * uniform(random));
    samples.v.push_back(v);
    samples.cos_i.push_back(0.8);
    samples.cos_o.push_back(0.3 + 0.7 * uniform(random));
    samples.weight.push_back(0.5 + uniform(random));
    for (std::size_t c = 0; c < truth.constant.size(); ++c) {
      double f_r = truth.constant[c];
      for (std::size_t l = 0; l < truth.lobes.size(); ++l)
        f_r += truth.amplitude[l][c] * SelLobeInFrame(truth.lobes[l]).Evaluate(v, nullptr);
      samples.f_r[c].push_back(f_r);
    }
  }
  return samples;
}

TEST(SelObjective, ArrowIsTheDenseMatrix) {
  const SelSlice truth = TwoLobes(7);
  const SelSamples samples = SamplesOf(truth, 150);
  SelSliceOptions options;
  options.quantity = SelQuantity::kBrdf;
  const std::vector<SelShape> neighbour = {{0.3, 0.2, 0, 0, 0.1}, {0.6, 0.6, 0, 0, 0}};
  const std::vector<SelPull> pulls = {{&neighbour, 2.5}};
  const SelObjective objective(samples, 2, options, pulls);
  SelSlice elsewhere = truth;
  elsewhere.lobes[0].alpha_x *= 1.1;
  elsewhere.amplitude[1][3] *= 2;
  const Eigen::VectorXd u = objective.From(elsewhere);

  Eigen::MatrixXd dense;
  ArrowMatrix arrow;
  Eigen::VectorXd gradient, arrow_gradient;
  const double cost = objective.SumSquares(u, &dense, &gradient) + objective.Pulls(u, &dense, &gradient);
  EXPECT_EQ(objective.SumSquares(u, &arrow, &arrow_gradient) + objective.Pulls(u, &arrow.border, &arrow_gradient),
            cost);
  EXPECT_LT((arrow.Dense() - dense).norm(), 1e-13 * dense.norm());
  EXPECT_EQ(arrow_gradient, gradient);
  // The gradient is that of half the sum.
  for (Eigen::Index k = 0; k < u.size(); ++k) {
    const double step = 1e-6;
    Eigen::VectorXd before = u, after = u;
    before(k) -= step;
    after(k) += step;
    Eigen::MatrixXd* none = nullptr;
    const auto half = [&](const Eigen::VectorXd& at) {
      return (objective.SumSquares(at, none, nullptr) + objective.Pulls(at, nullptr, nullptr)) / 2;
    };
    EXPECT_NEAR((half(after) - half(before)) / (2 * step), gradient(k), 1e-6 * (1 + std::abs(gradient(k)))) << k;
  }
}

TEST(FitSelSlice, FindsLobesOfManyChannels) {
  const SelSlice truth = TwoLobes(60);
  const SelSamples samples = SamplesOf(truth, 150);
  SelSliceOptions options;
  options.quantity = SelQuantity::kBrdf;
  SelSlice start = truth;
  start.lobes[0].alpha_x *= 1.2;
  start.lobes[1].psi -= 0.2;
  for (double& amplitude : start.amplitude[0]) amplitude *= 1.5;
  const SelSliceFit fit = FitSelSlice(samples, start, options);
  EXPECT_TRUE(fit.converged);
  EXPECT_LT(fit.sum_squares, 1e-9);
  EXPECT_NEAR(fit.slice.lobes[0].alpha_x, truth.lobes[0].alpha_x, 1e-5);
  EXPECT_NEAR(fit.slice.lobes[1].alpha_y, truth.lobes[1].alpha_y, 1e-5);
  for (std::size_t c = 0; c < truth.constant.size(); ++c) {
    EXPECT_NEAR(fit.slice.amplitude[0][c] / truth.amplitude[0][c], 1, 1e-4) << c;
    EXPECT_NEAR(fit.slice.constant[c] / truth.constant[c], 1, 1e-4) << c;
  }
}

}  // namespace
}  // namespace lobefit
