// Fits that move the half angles of the discs, rectangular detectors, discs that the horizon cuts; values without noise
// come back through every part of an instrument.
#include <cmath>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/fit.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/synthesis/instrument.h"

namespace lobefit {
namespace {

GoniometerLayout Grid(double step_deg = 5, double theta_max_deg = 80) {
  GoniometerLayout layout;
  for (const double degrees : {15., 35., 55.}) layout.polar_angles.push_back(DegreesToRadians(degrees));
  for (const double degrees : {0., 70., 140.}) layout.azimuths.push_back(DegreesToRadians(degrees));
  layout.detector_step = DegreesToRadians(step_deg);
  layout.theta_max = DegreesToRadians(theta_max_deg);
  return layout;
}

SyntheticCase Narrow() { return OneLobe(Ndf::kEllipsoid, 0.06, 0.03, 0.5, -0.5, 20, {0.7}, {0.02}); }

Measurement Seen(const SyntheticCase& truth, const Aperture& aperture, double noise, std::uint64_t seed,
                 const GoniometerLayout& layout) {
  const Reflectance reflectance(truth.model, truth.values, truth.channels.size());
  Noise terms;
  terms.multiplicative = noise;
  terms.source = aperture.source;
  terms.aperture = aperture.detector;
  terms.across = aperture.across;
  Measurement measurement = Synthesise(
      Goniometer(layout), {truth.channels, {}},
      [&](const Vec3& wi, const Vec3& wo, double* f_r) { reflectance.Evaluate(wi, wo, f_r); }, terms, seed,
      std::min(truth.values[0][0], truth.values[1][0]));
  measurement.source = "synthetic";
  return measurement;
}

// What the fit's own model reads at the truth: alignment, half angles (as differences) and offset given.
Measurement ReadByModel(const SyntheticCase& truth, const Recipe& recipe, const GoniometerLayout& layout,
                        const std::vector<double>& angles, double offset) {
  Measurement measurement = Seen(truth, {}, 0, 1, layout);
  Recipe started = recipe;
  for (std::size_t i = 0; i < started.parameters.size(); ++i) started.parameters[i].start = truth.values[i];
  started.instrument.drift.reset();
  const Layout coordinates(started, truth.channels);
  std::vector<double> u = coordinates.FromShapes(
      {{truth.values[0][0], truth.values[1][0], truth.values[2][0], truth.values[3][0], truth.values[4][0]}});
  std::copy(angles.begin(), angles.end(), u.begin() + static_cast<std::ptrdiff_t>(coordinates.first_angle()));
  if (recipe.instrument.offset) u.back() = offset;
  const Problem problem(measurement.samples, started);
  std::vector<std::vector<double>> values;
  ModelValues(problem.kernel_samples(), coordinates.ToKernel(u.data()), 0, problem.size(), &values);
  measurement.samples.values = values;
  return measurement;
}

Recipe RecipeFor(const SyntheticCase& truth) {
  Recipe recipe = DefaultRecipe(truth.model, "instrument");
  recipe.metric = Metric::kLog;
  recipe.metric_given = true;
  return recipe;
}

double Relative(const Material& material, const SyntheticCase& truth) {
  double largest = 0;
  for (std::size_t i = 0; i < truth.values.size(); ++i)
    largest = std::max(largest, std::fabs(material.parameters[i].values[0] - truth.values[i][0]) /
                                    std::max(0.01, std::fabs(truth.values[i][0])));
  return largest;
}

TEST(HalfAngleKernel, ColumnsEqualDifferences) {
  for (const Ndf ndf : {Ndf::kEllipsoid, Ndf::kBeckmannOffCenter}) {
    for (const bool crooked : {false, true}) {
      if (crooked && ndf != Ndf::kEllipsoid) continue;
      const SyntheticCase truth = OneLobe(ndf, 0.2, 0.15, 1, 2, 20, {0.7}, {0.05});
      Measurement measurement = Seen(truth, {}, 0.05, 1, Grid(40));
      Recipe recipe = RecipeFor(truth);
      recipe.instrument.source = DegreesToRadians(1.5);
      recipe.instrument.source_prior = DegreesToRadians(0.2);
      recipe.instrument.detector = DegreesToRadians(3);
      recipe.instrument.detector_prior = DegreesToRadians(0.3);
      if (crooked) recipe.instrument.alignment = AlignmentRecipe();
      const Layout coordinates(recipe, truth.channels);
      const Problem problem(measurement.samples, recipe);
      ASSERT_EQ(coordinates.shape_size() - coordinates.first_half_angle(), 2U);
      std::vector<double> u = coordinates.FromShapes({{0.2, 0.15, 0.02, 0.03, 0.3}});
      if (crooked) u[coordinates.first_angle()] = 0.004;
      u[coordinates.first_half_angle()] = 0.002;
      u[coordinates.first_half_angle() + 1] = -0.003;
      for (std::size_t k = coordinates.shape_size(); k < u.size(); ++k) u[k] = 0.4;
      std::vector<std::vector<double>> at, low, high;
      const std::size_t n = problem.size(), residual = coordinates.ToKernel(u.data()).columns() - 1;
      Columns(problem.kernel_samples(), coordinates.ToKernel(u.data()), 0, n, &at);
      for (std::size_t k = coordinates.first_angle(); k < coordinates.shape_size(); ++k) {
        const double step = 2e-5, kept = u[k];
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
        EXPECT_GT(largest, 0) << k;
        EXPECT_LT(worst, 1e-5 * largest) << coordinates.coordinates()[k].name;
      }
    }
  }
}

// Of a narrow lobe seen by a disc that is wider than it the half angle is found, though another was given.
TEST(HalfAngleFit, IsDeterminedByANarrowLobe) {
  const SyntheticCase truth = Narrow();
  Measurement measurement = Seen(truth, {0, DegreesToRadians(2.3)}, 0.02, 3, Grid());
  Measurement again = measurement;
  Recipe recipe = RecipeFor(truth);
  recipe.instrument.detector = DegreesToRadians(2);
  const Material fixed = CheckedFit(recipe, {}, &again);
  recipe.instrument.detector_prior = DegreesToRadians(0.2);
  const Material material = CheckedFit(recipe, {}, &measurement);
  ASSERT_EQ(material.instrument->half_angles.size(), 1U);
  const InstrumentHalfAngle& found = material.instrument->half_angles[0];
  EXPECT_EQ(found.name, "detector");
  EXPECT_TRUE(found.determined);
  EXPECT_EQ(material.instrument->detector, found.value);
  EXPECT_LT(std::fabs(found.value - DegreesToRadians(2.3)), 4 * found.standard_error);
  EXPECT_LT(found.standard_error, 0.5 * DegreesToRadians(0.2));
  EXPECT_THAT(material.remarks, testing::Contains(testing::HasSubstr("the samples determine its half angle")));
  // Held at what was given the widths are off by many of their errors.
  const auto errors = [&](const Material& m) {
    return std::fabs(m.parameters[1].values[0] - truth.values[1][0]) / m.parameters[1].standard_error[0];
  };
  EXPECT_LT(errors(material), 4);
  EXPECT_GT(errors(fixed), 8);
}

// A wide lobe says nothing of the disc: its error stays the prior's, and the result says so.
TEST(HalfAngleFit, IsNotDeterminedByAWideLobe) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.4, 0.3, 0.5, -0.5, 20, {0.7}, {0.02});
  Measurement measurement = Seen(truth, {0, DegreesToRadians(2)}, 0.05, 3, Grid(12));
  Recipe recipe = RecipeFor(truth);
  recipe.instrument.detector = DegreesToRadians(2);
  recipe.instrument.detector_prior = DegreesToRadians(0.2);
  const Material material = CheckedFit(recipe, {}, &measurement);
  const InstrumentHalfAngle& found = material.instrument->half_angles.at(0);
  EXPECT_FALSE(found.determined);
  EXPECT_NEAR(found.standard_error, found.prior, 0.3 * found.prior);
  EXPECT_THAT(material.remarks, testing::Contains(testing::HasSubstr("its half angle is not determined")));
  EXPECT_TRUE(material.termination.determined);
}

TEST(HalfAngleFit, IsRefusedWhereNoneIsKnown) {
  const SyntheticCase truth = Narrow();
  Measurement measurement = Seen(truth, {}, 0.02, 3, Grid(15));
  Recipe recipe = RecipeFor(truth);
  recipe.instrument.source_prior = DegreesToRadians(0.2);
  try {
    CheckedFit(recipe, {}, &measurement);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("neither the recipe nor the file states it; give --source"));
  }
}

TEST(RectangleFit, RecoversWhatADiscDoesNot) {
  const SyntheticCase truth = Narrow();
  const Aperture aperture = {0, DegreesToRadians(0.5), ApertureMean::kFlux, DegreesToRadians(3)};
  GoniometerLayout layout = Grid();
  layout.azimuths.resize(1);
  Measurement measurement = Seen(truth, aperture, 0.03, 3, layout), again = measurement;
  Recipe recipe = RecipeFor(truth);
  // A disc of the same solid angle.
  recipe.instrument.detector = std::sqrt(4 * aperture.detector * aperture.across / kPi);
  const Material as_disc = CheckedFit(recipe, {}, &again);
  recipe.instrument.detector = aperture.detector;
  recipe.instrument.detector_across = aperture.across;
  const Material material = CheckedFit(recipe, {}, &measurement);
  EXPECT_EQ(material.instrument->across, aperture.across);
  for (const std::size_t i : {0U, 1U}) {
    const double error = material.parameters[i].standard_error[0];
    EXPECT_LT(std::fabs(material.parameters[i].values[0] - truth.values[i][0]), 4 * error) << i;
    EXPECT_GT(std::fabs(as_disc.parameters[i].values[0] - truth.values[i][0]), 5 * error) << i;
  }
}

TEST(RectangleFit, SaysWhyItRefuses) {
  const SyntheticCase truth = Narrow();
  const auto message = [&](const auto& set) -> std::string {
    Measurement measurement = Seen(truth, {}, 0.02, 3, Grid(15));
    Recipe recipe = RecipeFor(truth);
    recipe.instrument.detector = DegreesToRadians(1);
    recipe.instrument.detector_across = DegreesToRadians(3);
    set(&recipe);
    try {
      CheckedFit(recipe, {}, &measurement);
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(message([](Recipe* r) { r->instrument.source = 0.01; }), testing::HasSubstr("give --source 0"));
  EXPECT_THAT(message([](Recipe* r) { r->instrument.detector.reset(); }),
              testing::HasSubstr("give --detector DEGREES"));
  EXPECT_THAT(message([](Recipe* r) { r->instrument.mean = ApertureMean::kPlain; }), testing::HasSubstr("of the flux"));
  EXPECT_THAT(message([](Recipe* r) { r->model.lobes[0].ndf = Ndf::kBeckmannOffCenter; }),
              testing::HasSubstr("in closed form"));
}

// Samples whose disc the horizon cuts are fitted, and their values are those of the part above.
TEST(ApertureFit, DiscsAtTheHorizonAreFitted) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.3, 0.2, 0.5, -0.5, 20, {0.7}, {0.05});
  const Aperture aperture = {0, DegreesToRadians(4)};
  GoniometerLayout layout = Grid(8, 89);
  layout.azimuths.resize(1);
  Measurement measurement = Seen(truth, aperture, 0, 1, layout);
  Recipe recipe = RecipeFor(truth);
  recipe.theta_max = kPi / 2;
  recipe.instrument.detector = aperture.detector;
  std::size_t low = 0, grazing = 0;
  for (std::size_t i = 0; i < measurement.samples.size(); ++i) {
    if (measurement.samples.wo_z[i] > std::sin(aperture.detector)) continue;
    const double cos_d = 0.5 * Norm(measurement.samples.wi(i) + measurement.samples.wo(i));
    (cos_d < 0.35 ? grazing : low) += 1;
  }
  ASSERT_GT(low, 20U);
  const std::size_t all = measurement.samples.size();
  const Material material = CheckedFit(recipe, {}, &measurement);
  EXPECT_EQ(material.samples_used, all - grazing);
  EXPECT_LT(Relative(material, truth), 2e-3);
}

// Through every part of an instrument values without noise give the truth again, from the fit's own starts.
TEST(InstrumentFit, ValuesWithoutNoiseComeBack) {
  const SyntheticCase truth = Narrow();
  const double degree = kPi / 180;
  Recipe one_disc = RecipeFor(truth);
  one_disc.instrument.detector = 1.5 * degree;
  Recipe both_discs = one_disc;
  both_discs.instrument.source = 1 * degree;
  Recipe half_angle = one_disc;
  half_angle.instrument.detector_prior = 0.2 * degree;
  Recipe rectangle = one_disc;
  rectangle.instrument.detector_across = 3 * degree;
  Recipe offset = one_disc;
  offset.instrument.offset = true;
  const struct {
    const char* name;
    Recipe recipe;
    std::vector<double> angles;
    double offset;
  } cases[] = {{"one disc", one_disc, {}, 0},
               {"both discs", both_discs, {}, 0},
               {"half angle", half_angle, {0.1 * degree}, 0},
               {"rectangle", rectangle, {}, 0},
               {"offset", offset, {}, 0.01}};
  for (const auto& c : cases) {
    Measurement measurement = ReadByModel(truth, c.recipe, Grid(8), c.angles, c.offset);
    const Material material = CheckedFit(c.recipe, {}, &measurement);
    EXPECT_LT(Relative(material, truth), 1e-6) << c.name;
  }
}

TEST(InstrumentFit, ValuesWithoutNoiseComeBackFromACrookedSampleThatWasTurned) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.3, 0.1, 0, 2, 20, {0.7}, {0.02});
  const double degree = kPi / 180;
  Recipe recipe = RecipeFor(truth);
  recipe.instrument.alignment = AlignmentRecipe();
  recipe.instrument.alignment->azimuths = {0, kPi};
  // Both turns in one measurement, the second half of the samples.
  Measurement measurement = Seen(truth, {}, 0, 1, Grid(8));
  Samples& s = measurement.samples;
  for (std::size_t i = 0; i < s.size(); ++i) s.sample_azimuth.push_back(i % 2 == 0 ? 0 : kPi);
  Recipe started = recipe;
  for (std::size_t i = 0; i < started.parameters.size(); ++i) started.parameters[i].start = truth.values[i];
  const Layout coordinates(started, truth.channels);
  std::vector<double> u = coordinates.FromShapes(
      {{truth.values[0][0], truth.values[1][0], truth.values[2][0], truth.values[3][0], truth.values[4][0]}});
  const double angles[] = {0.15 * degree, -0.1 * degree, 0.2 * degree};
  std::copy(std::begin(angles), std::end(angles), u.begin() + static_cast<std::ptrdiff_t>(coordinates.first_angle()));
  const Problem problem(s, started);
  std::vector<std::vector<double>> values;
  ModelValues(problem.kernel_samples(), coordinates.ToKernel(u.data()), 0, problem.size(), &values);
  s.values = values;
  const Material material = CheckedFit(recipe, {}, &measurement);
  EXPECT_LT(Relative(material, truth), 1e-6);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(material.instrument->alignment[k].value, angles[k], 1e-6 * degree) << k;
}

// Gains whose logarithms have the mean 0; another mean is f0's.
TEST(InstrumentFit, ValuesWithoutNoiseComeBackThroughGains) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.3, 0.1, 0, 2, 20, {0.7}, {0.02});
  Measurement measurement = Seen(truth, {}, 0, 1, Grid(8));
  const Incidences incidences = GroupByIncidence(measurement);
  const double logarithms[] = {0.03, -0.05, 0.02, 0.04, -0.04, 0, 0.01, -0.02, 0.01};
  ASSERT_EQ(incidences.wi.size(), std::size(logarithms));
  for (std::size_t i = 0; i < measurement.samples.size(); ++i)
    measurement.samples.values[0][i] *= std::exp(logarithms[incidences.group[i]]);
  Recipe recipe = RecipeFor(truth);
  recipe.instrument.drift = DriftRecipe{0.05};
  const Material material = CheckedFit(recipe, {}, &measurement);
  EXPECT_LT(Relative(material, truth), 1e-6);
  for (std::size_t k = 0; k < std::size(logarithms); ++k)
    EXPECT_NEAR(material.instrument->gains[k].gain, std::exp(logarithms[k]), 1e-6) << k;
}

}  // namespace
}  // namespace lobefit
