// What a fit reflects in all: said where it is more than it receives, and kept from it where the recipe asks.
#include "lobefit/fit/keep_energy.h"

#include <cmath>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/core/brdf/model_energy.h"
#include "lobefit/fit/fit.h"
#include "lobefit/fit/inference/energy_balance.h"
#include "lobefit/math/directions.h"
#include "lobefit/recipe/free_scale.h"

namespace lobefit {
namespace {

// Mirror-like and white at once: each part is at most 1, both reflect up to 1.5.
SyntheticCase BrightTruth() {
  return OneLobe(Ndf::kGgxAnisotropic, 0.3, 0.2, 0, 0, 0.4, {0.9, 0.5, 0.2}, {0.6, 0.5, 0.1});
}

Material FitOf(EnergyChoice energy, const Recipe* recipe = nullptr) {
  Measurement measurement = Synthetic(BrightTruth(), StandardLayout(), 0.02, 5);
  Recipe fitted = recipe != nullptr ? *recipe : DefaultRecipe(BrightTruth().model, "truth");
  fitted.energy = energy;
  return CheckedFit(fitted, {}, &measurement);
}

double LargestAlbedo(const Material& material) {
  Measurement measurement = Synthetic(BrightTruth(), StandardLayout(), 0.02, 5);
  double largest = 0;
  for (const Vec3& wi : GroupByIncidence(measurement).wi) {
    if (wi.z < std::cos(80 * kPi / 180)) continue;
    for (const double a : DirectionalAlbedo(material.model, material.Values(), 3, wi)) largest = std::fmax(largest, a);
  }
  return largest;
}

TEST(EnergyBalance, ATruthThatCreatesEnergyIsRoughAndSaysWhere) {
  const Material material = FitOf(EnergyChoice::kFree);
  ASSERT_TRUE(material.energy);
  EXPECT_NEAR(material.energy->albedo, LargestAlbedo(material), 0.01);
  EXPECT_GT(material.energy->albedo, 1.2);
  EXPECT_EQ(material.energy->channel, "R");
  EXPECT_GT(material.energy->above_one, 0U);
  EXPECT_EQ(material.verdict->kind, VerdictKind::kRough);
  EXPECT_NE(material.verdict->advice.find("--energy conserving"), std::string::npos);
}

TEST(EnergyBalance, OfAFreeScaleIsNotAbsolute) {
  const Recipe recipe = WithFreeScale(DefaultRecipe(BrightTruth().model, "truth"));
  const Material material = FitOf(EnergyChoice::kFree, &recipe);
  EXPECT_FALSE(material.energy->absolute);
  EXPECT_NE(material.verdict->kind, VerdictKind::kRough);
}

TEST(KeepEnergy, KeepsTheAlbedoAtMostOneAndIsTheBestThatDoes) {
  const Material free = FitOf(EnergyChoice::kFree), kept = FitOf(EnergyChoice::kConserving);
  EXPECT_TRUE(kept.termination.converged) << kept.termination.message;
  EXPECT_LE(LargestAlbedo(kept), 1.0);
  EXPECT_GT(LargestAlbedo(kept), 0.99);
  EXPECT_GT(kept.cost, free.cost);
  // The blue channel was never above 1, and may move with the common shape only.
  EXPECT_NEAR(kept.parameters[5].values[2], free.parameters[5].values[2], 0.05);
  // Shrinking the free fit's amplitudes until it keeps energy costs more.
  const Measurement measurement = Synthetic(BrightTruth(), StandardLayout(), 0.02, 5);
  const Recipe recipe = DefaultRecipe(BrightTruth().model, "scaled");
  const Layout layout(recipe, {"R", "G", "B"});
  const ParameterValues values = free.Values();
  std::vector<double> u = layout.FromShapes({{values[0][0], values[1][0], 0, 0, values[4][0]}});
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 2; ++k)
      u[static_cast<std::size_t>(layout.linear(c)[k].index)] = values[5 + k][c] / LargestAlbedo(free);
  }
  ThreadPool pool(1);
  const Problem problem(measurement.samples, recipe);
  EXPECT_LT(kept.cost, problem.Sum(layout.ToKernel(u.data()), false, &pool).sum_rho / 2);
}

TEST(KeepEnergy, ChangesNothingThatKeepsEnergyAnyway) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0);
  Recipe recipe = DefaultRecipe(truth.model, "truth");
  Measurement first = Synthetic(truth, StandardLayout(), 0.02, 5), second = first;
  const Material free = CheckedFit(recipe, {}, &first);
  recipe.energy = EnergyChoice::kConserving;
  EXPECT_EQ(CheckedFit(recipe, {}, &second).Values(), free.Values());
}

TEST(KeepEnergy, RefusesWhatIsFittedApartFromTheSurface) {
  Recipe recipe = DefaultRecipe(BrightTruth().model, "truth");
  recipe.instrument.drift = DriftRecipe{};
  EXPECT_THROW(FitOf(EnergyChoice::kConserving, &recipe), InputError);
}

// The penalty's gradient is that of its value.
TEST(EnergyRule, GradientIsThatOfTheValue) {
  const SyntheticCase truth = BrightTruth();
  const Recipe recipe = DefaultRecipe(truth.model, "truth");
  const Layout layout(recipe, {"R", "G", "B"});
  std::vector<double> u = layout.FromShapes({{0.3, 0.2, 0, 0, 0.4}});
  for (std::size_t i = layout.shape_size(); i < u.size(); ++i) u[i] = 0.7;
  EnergyRule rule({FromSpherical(0.4, 0.3), FromSpherical(1.1, 2.0)}, 0.998);
  rule.SetWeight(3);
  rule.Place(layout.ToKernel(u.data()));
  ThreadPool pool(1);
  const auto n = static_cast<Eigen::Index>(u.size());
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
  EXPECT_GT(rule.Add(layout, u.data(), &pool, &hessian, &gradient), 0);
  for (std::size_t k = 0; k < u.size(); ++k) {
    const auto at = [&](double by) {
      std::vector<double> moved = u;
      moved[k] += by;
      return rule.Add(layout, moved.data(), &pool, nullptr, nullptr);
    };
    const double difference = (at(1e-5) - at(-1e-5)) / 2e-5;
    EXPECT_NEAR(gradient(static_cast<Eigen::Index>(k)), difference, 1e-6 * (1 + std::fabs(difference))) << k;
  }
}

}  // namespace
}  // namespace lobefit
