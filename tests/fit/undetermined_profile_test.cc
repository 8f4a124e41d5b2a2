// Coefficients of a profile that the samples do not reach: named, without an error, near GGX's.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <Eigen/QR>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/fit.h"
#include "lobefit/fit/model_report.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/search.h"
#include "lobefit/fit/search/solve.h"

namespace lobefit {
namespace {

constexpr double kAlpha = 0.12;

const std::vector<double> kFarKnots = {0, 1, 2, 4, 8, 16, 32, 64};  // in alphas

// A GGX lobe in so many channels, written as a profile.
SyntheticCase ProfileWithKnots(std::vector<double> knots, std::size_t channels) {
  SyntheticCase truth;
  Lobe lobe = {Ndf::kProfile};
  lobe.grid = GridWithKnots(std::move(knots));
  truth.model = {{lobe}, Diffuse::kLambert};
  truth.values = {{kAlpha}, {kAlpha}, {0}, {0}, {0}};
  for (std::size_t k = 0; k < lobe.grid->spline()->size(); ++k) truth.values.push_back({0});
  truth.channels.clear();
  std::vector<double> f0, albedo;
  for (std::size_t c = 0; c < channels; ++c) {
    truth.channels.push_back(fmt::format("c{}", c));
    f0.push_back(0.3 + 0.5 * static_cast<double>(c) / static_cast<double>(channels));
    albedo.push_back(0.05);
  }
  truth.values.push_back(f0);
  truth.values.push_back(albedo);
  return truth;
}

double SlopeOf(const Samples& samples, std::size_t i) {
  const Vec3 wh = samples.wi(i) + samples.wo(i);
  return std::hypot(wh.x, wh.y) / wh.z;
}
double LargestSlope(const Samples& samples) {
  double largest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) largest = std::max(largest, SlopeOf(samples, i));
  return largest;
}

// What of it has half vectors within so many alphas of the normal.
Measurement Within(const SyntheticCase& truth, double radius, double noise = 0.02) {
  GoniometerLayout layout = StandardLayout();
  layout.polar_angles = {0.1, 0.4, 0.7, 1.0};
  layout.azimuths = {0};
  layout.detector_step = DegreesToRadians(6);
  Measurement measurement = Synthetic(truth, layout, noise, 1);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < measurement.samples.size(); ++i) {
    if (SlopeOf(measurement.samples, i) < radius * kAlpha) kept.push_back(i);
  }
  measurement.samples = measurement.samples.Subset(kept);
  return measurement;
}

// The coefficients that are said to be not determined.
std::vector<std::string> Named(const Material& material) {
  std::vector<std::string> named;
  for (const std::string& what : material.degenerate) {
    if (what.find("is not determined by these samples") != std::string::npos)
      named.push_back(what.substr(0, what.find(':')));
  }
  return named;
}

TEST(UndeterminedProfile, KnotsBeyondTheSamplesAreNamedAndHeldNearGgx) {
  const SyntheticCase truth = ProfileWithKnots(kFarKnots, 1);
  Measurement measurement = Within(truth, 5);
  const Material material = CheckedFit(DefaultRecipe(truth.model, "test"), {}, &measurement);
  EXPECT_TRUE(material.termination.converged) << material.termination.message;
  const std::vector<std::string> named = Named(material);
  const std::vector<Parameter> parameters = Parameters(truth.model);
  const ProfileSpline& spline = *truth.model.lobes[0].grid->spline();
  for (std::size_t k = 0; k < spline.size(); ++k) {
    const std::string& name = parameters[kEllipseParameters + k].name;
    SCOPED_TRACE(name);
    const FittedParameter& fitted = material.parameters[kEllipseParameters + k];
    const bool is_named = std::find(named.begin(), named.end(), name) != named.end();
    EXPECT_EQ(std::isnan(fitted.standard_error[0]), is_named);
    // Half vectors end at 5 alphas.
    EXPECT_TRUE(is_named || spline.FirstRadius(k) <= 5);
    EXPECT_TRUE(!is_named || spline.FirstRadius(k) > 1);
    EXPECT_LT(std::fabs(fitted.values[0]), is_named ? 1 : 4 * fitted.standard_error[0]);
  }
  ASSERT_FALSE(material.degenerate.empty());
  EXPECT_NE(material.degenerate.back().find("it is held near GGX's"), std::string::npos);
  EXPECT_LT(std::fabs(material.parameters[0].values[0] - kAlpha), 4 * material.parameters[0].standard_error[0]);
}

TEST(UndeterminedProfile, NothingIsNamedWhereAllKnotsAreReached) {
  const SyntheticCase truth = ProfileWithKnots({0, 1, 2, 4}, 1);
  Measurement measurement = Within(truth, 30);
  EXPECT_TRUE(Named(CheckedFit(DefaultRecipe(truth.model, "test"), {}, &measurement)).empty());
}

// By definition those that begin beyond the half vectors, and those whose variance from samples and prior is more than
// half of the prior's, by the whole inverse; the program inverts by blocks. Noisy samples within 1.2 alphas tell little
// of what begins at 1 or less.
class OfManyChannels : public testing::TestWithParam<std::size_t> {};
TEST_P(OfManyChannels, AreThoseOfTheWholeInverse) {
  const SyntheticCase truth = ProfileWithKnots(kFarKnots, GetParam());
  Measurement measurement = Within(truth, 1.2, 0.4);
  const Recipe recipe = DefaultRecipe(truth.model, "test");
  SetAsideForRecipe(recipe, &measurement);
  const Layout layout(recipe, truth.channels);
  const Problem problem(measurement.samples, recipe);
  ThreadPool pool(1);
  FitOptions options;
  options.subsample = 300;
  const std::vector<DistinctMinimum> minima = FindMinima(problem, layout, measurement.samples, options, &pool);
  ASSERT_FALSE(minima.empty());
  const std::vector<double>& u = minima[0].solution.u;

  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  const double cost = Linearise(problem, layout, u.data(), &pool, &hessian, &gradient);
  const double square = 2 * cost / static_cast<double>(problem.size() * problem.channels());
  const Eigen::MatrixXd inverse = hessian.completeOrthogonalDecomposition().pseudoInverse();
  const double alpha = layout.Report(u.data())[0][0];
  const ProfileSpline& spline = *truth.model.lobes[0].grid->spline();
  std::vector<std::string> expected;
  std::size_t coefficient = 0, by_prior = 0;
  for (Eigen::Index k = 0; k < inverse.rows(); ++k) {
    const Coordinate& coordinate = layout.coordinates()[static_cast<std::size_t>(k)];
    if (coordinate.prior == 0) continue;
    const bool is_beyond = spline.FirstRadius(coefficient++) * alpha > LargestSlope(measurement.samples);
    const bool is_prior = square * inverse(k, k) * coordinate.prior > 0.5;
    if (is_beyond || is_prior) expected.push_back(coordinate.name);
    if (!is_beyond && is_prior) ++by_prior;
  }
  EXPECT_GT(by_prior, 0U);

  Material material;
  material.model = truth.model;
  for (std::size_t i = 0; i < Parameters(truth.model).size(); ++i)
    material.parameters.emplace_back() = {{5}, {1}, {1}, {1}};
  FlagUndeterminedProfiles(problem, layout, u, measurement.samples, &pool, &material);
  EXPECT_EQ(Named(material), expected);
  for (const std::string& what : material.degenerate)
    EXPECT_NE(what.find("its value of 5, far from GGX's 0"), what.npos);
}
INSTANTIATE_TEST_SUITE_P(Channels, OfManyChannels, testing::Values(1, 3, 60));

}  // namespace
}  // namespace lobefit
