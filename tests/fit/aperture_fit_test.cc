// Fits through the discs of source and detector: gradients, recovery of what a point model misses, what is refused.
#include <cmath>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/fit.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/synthesis/instrument.h"

namespace lobefit {
namespace {

Aperture Discs(double source_deg, double detector_deg, ApertureMean mean = ApertureMean::kFlux) {
  return {DegreesToRadians(source_deg), DegreesToRadians(detector_deg), mean};
}

GoniometerLayout Fine() {
  GoniometerLayout layout;
  for (const double degrees : {10., 30., 50., 65.}) layout.polar_angles.push_back(DegreesToRadians(degrees));
  for (const double degrees : {0., 60., 120.}) layout.azimuths.push_back(DegreesToRadians(degrees));
  layout.detector_step = DegreesToRadians(4);
  return layout;
}

Measurement Seen(const SyntheticCase& truth, const GoniometerLayout& layout, const Aperture& aperture, double noise,
                 std::uint64_t seed) {
  const Reflectance reflectance(truth.model, truth.values, truth.channels.size());
  const BrdfFunction seen =
      WithAperture([&](const Vec3& wi, const Vec3& wo, double* f_r) { reflectance.Evaluate(wi, wo, f_r); }, aperture,
                   truth.channels.size(), std::min(truth.values[0][0], truth.values[1][0]));
  Noise terms;
  terms.multiplicative = noise;
  Measurement measurement = Synthesise(Goniometer(layout), {truth.channels, {}}, seen, terms, seed);
  measurement.source = "synthetic";
  return measurement;
}

Recipe RecipeOf(const SyntheticCase& truth, const Aperture& aperture) {
  Recipe recipe = DefaultRecipe(truth.model, "through discs");
  recipe.instrument.source = aperture.source;
  recipe.instrument.detector = aperture.detector;
  recipe.instrument.mean = aperture.mean;
  return recipe;
}

// Columns of the kernel against differences of its residuals, for every kind of Fresnel factor, closed form and
// cubature, one disc and two.
TEST(ApertureKernel, ColumnsEqualDifferences) {
  for (const Fresnel fresnel : {Fresnel::kSchlick, Fresnel::kConductor, Fresnel::kDielectric, Fresnel::kNone}) {
    for (const Ndf ndf : {Ndf::kEllipsoid, Ndf::kBeckmannOffCenter}) {
      for (const Aperture& aperture : {Discs(0, 3), Discs(1, 3), Discs(2, 0, ApertureMean::kPlain)}) {
        SyntheticCase truth = OneLobe(ndf, 0.2, 0.15, 1, 2, 20, {0.7}, {0.05});
        truth.model.lobes[0].fresnel = fresnel;
        if (fresnel == Fresnel::kConductor) truth.values = {{0.2}, {0.15}, {0.02}, {0.03}, {0.3}, {0.5}, {2.5}, {0.05}};
        if (fresnel == Fresnel::kDielectric) truth.values[5] = {1.5};
        GoniometerLayout layout = Fine();
        layout.detector_step = DegreesToRadians(25);
        const Measurement measurement = Seen(truth, layout, {}, 0.05, 1);
        Recipe recipe = RecipeOf(truth, aperture);
        // Without the cube root's pole.
        recipe.metric = Metric::kLog;
        const Layout coordinates(recipe, truth.channels);
        const Problem problem(measurement.samples, recipe);
        std::vector<double> u = coordinates.FromShapes({{0.2, 0.15, 0.02, 0.03, 0.3}});
        for (std::size_t k = coordinates.shape_size(); k < u.size(); ++k) u[k] = 0.4;
        std::vector<std::vector<double>> at, low, high;
        Columns(problem.kernel_samples(), coordinates.ToKernel(u.data()), 0, problem.size(), &at);
        const std::size_t n = problem.size(), residual = coordinates.ToKernel(u.data()).columns() - 1;
        for (std::size_t k = 0; k < u.size(); ++k) {
          const double step = 1e-6, kept = u[k];
          u[k] = kept - step;
          Columns(problem.kernel_samples(), coordinates.ToKernel(u.data()), 0, n, &low);
          u[k] = kept + step;
          Columns(problem.kernel_samples(), coordinates.ToKernel(u.data()), 0, n, &high);
          u[k] = kept;
          double largest = 0, worst = 0;
          for (std::size_t i = 0; i < n; ++i) {
            const double expected = (high[0][residual * n + i] - low[0][residual * n + i]) / (2 * step);
            largest = std::max(largest, std::fabs(expected));
            worst = std::max(worst, std::fabs(at[0][k * n + i] - expected));
          }
          EXPECT_LT(worst, 1e-6 * largest) << "coordinate " << k << ", fresnel " << static_cast<int>(fresnel);
        }
      }
    }
  }
}

double Alpha(const Material& material) { return material.parameters[1].values[0]; }

// A lobe a fifth as wide as the detector's disc: through the aperture it is found to a fifth of a standard error, as a
// point it is far off.
TEST(ApertureFit, RecoversLobesNarrowerThanTheDisc) {
  for (const double alpha : {0.05, 0.02, 0.007}) {
    const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 1.5 * alpha, alpha, 0.5, -0.5, 20, {0.7}, {0.02});
    const Aperture aperture = Discs(0, 2);
    Measurement clean = Seen(truth, Fine(), aperture, 0, 1), noisy = Seen(truth, Fine(), aperture, 0.05, 1);
    const Material exact = CheckedFit(RecipeOf(truth, aperture), {}, &clean),
                   found = CheckedFit(RecipeOf(truth, aperture), {}, &noisy),
                   as_point = CheckedFit(RecipeOf(truth, {}), {}, &noisy);
    const double error = found.parameters[1].standard_error[0];
    // Without noise what is left is the error of the means.
    EXPECT_LT(std::fabs(Alpha(exact) - alpha), 0.2 * error) << alpha;
    EXPECT_LT(std::fabs(Alpha(found) - alpha), 4 * error) << alpha;
    EXPECT_GT(std::fabs(Alpha(as_point) - alpha), 5 * error) << alpha;
    EXPECT_EQ(found.instrument->detector, aperture.detector);
    EXPECT_EQ(found.instrument->mean, "flux");
    EXPECT_FALSE(as_point.instrument.has_value());
  }
}

TEST(ApertureFit, BothDiscs) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.05, 0.02, 0.5, -0.5, 20, {0.7}, {0.02});
  const Aperture aperture = Discs(1, 1.5);
  GoniometerLayout layout = Fine();
  layout.azimuths.resize(2);
  layout.detector_step = DegreesToRadians(6);
  Measurement clean = Seen(truth, layout, aperture, 0, 1), noisy = Seen(truth, layout, aperture, 0.05, 1);
  const Material exact = CheckedFit(RecipeOf(truth, aperture), {}, &clean),
                 found = CheckedFit(RecipeOf(truth, aperture), {}, &noisy);
  EXPECT_LT(std::fabs(Alpha(exact) - 0.02), 0.2 * found.parameters[1].standard_error[0]);
  EXPECT_LT(std::fabs(Alpha(found) - 0.02), 4 * found.parameters[1].standard_error[0]);
}

TEST(ApertureFit, FileStatesTheDiscsUnlessTheRecipeDoes) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.05, 0.05, 0, 0, 0, {0.7}, {0.02});
  Measurement measurement = Seen(truth, Fine(), Discs(0, 2), 0, 1);
  measurement.instrument.detector = DegreesToRadians(2);
  Measurement again = measurement;
  const Material stated = CheckedFit(DefaultRecipe(truth.model, "ggx"), {}, &measurement);
  EXPECT_NEAR(stated.parameters[0].values[0], 0.05, 1e-4);
  EXPECT_EQ(stated.instrument->detector, DegreesToRadians(2));
  Recipe point = DefaultRecipe(truth.model, "ggx");
  point.instrument.detector = 0;
  EXPECT_FALSE(CheckedFit(point, {}, &again).instrument.has_value());
}

TEST(ApertureFit, RefusesDiscsFarWiderThanTheGrid) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.05, 0.05, 0, 0, 0, {0.7}, {0.02});
  Measurement measurement = Seen(truth, Fine(), {}, 0, 1);
  try {
    CheckedFit(RecipeOf(truth, Discs(0, 25)), {}, &measurement);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("times the step between neighbouring directions"));
  }
}

TEST(ApertureFit, CountsDiscsThatReachTheHorizon) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.3, 0.3, 0, 0, 0, {0.7}, {0.02});
  GoniometerLayout layout = Fine();
  layout.theta_max = DegreesToRadians(88);
  Measurement measurement = Seen(truth, layout, {}, 0, 1);
  Recipe recipe = RecipeOf(truth, Discs(1, 4));
  recipe.theta_max = kPi / 2;
  const Material material = CheckedFit(recipe, {}, &measurement);
  EXPECT_GT(material.set_aside.at("disc_at_horizon"), 0U);
  std::size_t all = material.samples_used;
  for (const auto& [reason, count] : material.set_aside) all += count;
  EXPECT_EQ(all, material.samples_read);
}

// The same numbers with any number of threads.
TEST(ApertureFit, DoesNotDependOnThreads) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.05, 0.02, 0.5, -0.5, 20, {0.7}, {0.02});
  FitOptions many;
  many.threads = 8;
  Measurement a = Seen(truth, Fine(), Discs(0, 2), 0.05, 1), b = a;
  const Material one = CheckedFit(RecipeOf(truth, Discs(0, 2)), {}, &a),
                 eight = CheckedFit(RecipeOf(truth, Discs(0, 2)), many, &b);
  for (std::size_t i = 0; i < one.parameters.size(); ++i)
    EXPECT_EQ(one.parameters[i].values, eight.parameters[i].values);
}

}  // namespace
}  // namespace lobefit
