#include "lobefit/fit/fit.h"

#include <algorithm>
#include <cmath>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

SyntheticCase BrushedMetal() {
  return OneLobe(Ndf::kEllipsoid, 0.35, 0.11, 0, 3, 25, {0.71, 0.66, 0.58}, {0.02, 0.018, 0.015});
}

// |value - truth| in units of the larger of 1 and the truth, for angles radians.
void ExpectRecovered(const Material& material, const SyntheticCase& truth, double tolerance) {
  for (std::size_t i = 0; i < truth.values.size(); ++i) {
    for (std::size_t c = 0; c < truth.values[i].size(); ++c) {
      const double expected = truth.values[i][c];
      const double scale = expected != 0 ? std::fabs(expected) : 1.0;
      EXPECT_NEAR(material.parameters[i].values[c], expected, tolerance * scale) << i << " " << c;
    }
  }
}

TEST(Fit, RecoversANoiseFreeMaterial) {
  Measurement measurement = Synthetic(BrushedMetal(), StandardLayout(), 0, 1);
  const Material material = CheckedFit(AutomaticRecipe(TraitsOf(measurement)), {}, &measurement);
  EXPECT_TRUE(material.termination.converged);
  EXPECT_TRUE(material.termination.determined);
  EXPECT_TRUE(material.degenerate.empty());
  ExpectRecovered(material, BrushedMetal(), 1e-8);
}

TEST(Fit, RecoversANoisyMaterialWithinItsErrors) {
  Measurement measurement = Synthetic(BrushedMetal(), StandardLayout(), 0.05, 1);
  const Material material = CheckedFit(AutomaticRecipe(TraitsOf(measurement)), {}, &measurement);
  const SyntheticCase truth = BrushedMetal();
  for (std::size_t i = 0; i < truth.values.size(); ++i) {
    for (std::size_t c = 0; c < truth.values[i].size(); ++c) {
      const double z =
          (material.parameters[i].values[c] - truth.values[i][c]) / material.parameters[i].standard_error[c];
      EXPECT_LT(std::fabs(z), 3.5) << i << " " << c;  // 11 parameters: one in 200 seeds exceeds it
    }
  }
}

// Spread over repeated trials against the reported errors: the ratio of variances has a relative standard deviation of
// sqrt(2 / trials).
TEST(Fit, StandardErrorsMatchTheSpreadOverTrials) {
  constexpr int kTrials = 60;
  const SyntheticCase truth = BrushedMetal();
  std::vector<double> sum_z2(truth.values.size(), 0.0);
  for (int trial = 0; trial < kTrials; ++trial) {
    Measurement measurement = Synthetic(truth, StandardLayout(), 0.05, 100 + static_cast<std::uint64_t>(trial));
    const Material material = CheckedFit(AutomaticRecipe(TraitsOf(measurement)), {}, &measurement);
    for (std::size_t i = 0; i < truth.values.size(); ++i) {
      const double z =
          (material.parameters[i].values[0] - truth.values[i][0]) / material.parameters[i].standard_error[0];
      sum_z2[i] += z * z;
    }
  }
  for (std::size_t i = 0; i < truth.values.size(); ++i) {
    const double ratio = sum_z2[i] / kTrials;
    // Four standard deviations of chi-square over 60 trials: 4 sqrt(2 / 60) = 0.73.
    EXPECT_NEAR(ratio, 1.0, 0.73) << i;
    EXPECT_GT(ratio, 0.5) << i;
  }
}

// Each entry of the document says whether it stands at a bound: one that the recipe gives, and none where the truth
// lies inside.
TEST(Fit, EachParameterSaysWhetherItStandsAtABound) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.3, 0.3, 0, 0, 0);
  Measurement measurement = Synthetic(truth, StandardLayout(), 0.02, 1);
  Recipe recipe = DefaultRecipe(truth.model, "bounded");
  for (const FittedParameter& parameter : CheckedFit(recipe, {}, &measurement).parameters)
    EXPECT_FALSE(parameter.at_bound);
  recipe.parameters[0].start = {0.2};
  recipe.parameters[0].high = 0.25;
  recipe.parameters[5].high = 0.45;  // of F0: 0.7, 0.6, 0.5
  const Material bounded = CheckedFit(recipe, {}, &measurement);
  EXPECT_NEAR(bounded.parameters[0].values[0], 0.25, 1e-9);
  EXPECT_NEAR(bounded.parameters[5].values[0], 0.45, 1e-9);
  EXPECT_TRUE(bounded.parameters[0].at_bound);
  EXPECT_TRUE(bounded.parameters[5].at_bound);
  EXPECT_FALSE(bounded.parameters[6].at_bound);
}

// Factors may be up to 1e6, so that a small one is no hundred-millionth of the range away from 0.
TEST(Fit, ASmallFactorIsNotAtItsBound) {
  SyntheticCase truth = OneLobe(Ndf::kGgx, 0.1, 0.1, 0, 0, 0, {2e-4}, {0.1});
  truth.model.lobes[0].fresnel = Fresnel::kNone;
  Measurement measurement = Synthetic(truth, StandardLayout(), 0.01, 1);
  const Material material = CheckedFit(DefaultRecipe(truth.model, "scale"), {}, &measurement);
  const FittedParameter& scale = material.parameters[5];
  EXPECT_FALSE(scale.at_bound);
  EXPECT_NEAR(scale.values[0], 2e-4, 4 * scale.standard_error[0]);
  EXPECT_LT(scale.standard_error[0], 2e-5);
}

TEST(Fit, SameBitsOnOneAndEightThreads) {
  Material materials[2];
  for (int k = 0; k < 2; ++k) {
    Measurement measurement = Synthetic(BrushedMetal(), StandardLayout(), 0.05, 9);
    FitOptions options;
    options.threads = k == 0 ? 1 : 8;
    options.subsample = 500;  // so that both stages run
    materials[k] = CheckedFit(AutomaticRecipe(TraitsOf(measurement)), options, &measurement);
  }
  EXPECT_EQ(materials[0].cost, materials[1].cost);
  EXPECT_EQ(materials[0].covariance, materials[1].covariance);
  for (std::size_t i = 0; i < materials[0].parameters.size(); ++i) {
    EXPECT_EQ(materials[0].parameters[i].values, materials[1].parameters[i].values);
  }
}

TEST(Fit, SaysThatTheAxesOfAnIsotropicMaterialHaveNoDirection) {
  Measurement measurement = Synthetic(OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0), StandardLayout(), 0.05, 4);
  const Material material = CheckedFit(AutomaticRecipe(TraitsOf(measurement)), {}, &measurement);
  ASSERT_EQ(material.degenerate.size(), 1U);
  EXPECT_NE(material.degenerate[0].find("theta_z: alpha_x and alpha_y agree within"), std::string::npos)
      << material.degenerate[0];
  EXPECT_TRUE(std::isnan(material.parameters[4].standard_error[0]));
  EXPECT_TRUE(material.termination.determined);
}

TEST(Fit, AnEllipsoidOnAnIsotropicTableIsRound) {
  // Every half vector in the xz plane, as in a MERL table: alone they say nothing of alpha_y.
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.15, 0.15, 0, 0, 0);
  GoniometerLayout layout = StandardLayout();
  layout.azimuths = {0};
  Measurement measurement = Synthetic(truth, layout, 0, 1);
  Samples& samples = measurement.samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 h = HalfVector(samples.wi(i), samples.wo(i));
    const double phi = std::atan2(h.y, h.x), c = std::cos(phi), s = std::sin(phi);
    for (auto [x, y] : {std::pair{&samples.wi_x[i], &samples.wi_y[i]}, std::pair{&samples.wo_x[i], &samples.wo_y[i]}}) {
      const double old_x = *x;
      *x = c * old_x + s * *y;
      *y = -s * old_x + c * *y;
    }
  }
  measurement.isotropic = true;
  const Material material = CheckedFit(DefaultRecipe({{Lobe{}}, Diffuse::kLambert}, "ellipsoid"), {}, &measurement);
  EXPECT_TRUE(material.termination.converged);
  EXPECT_TRUE(material.termination.determined);
  EXPECT_NEAR(material.parameters[0].values[0], 0.15, 1e-8);
  EXPECT_NEAR(material.parameters[1].values[0], 0.15, 1e-8);
}

TEST(Fit, SaysWhatTheDataDoNotDetermine) {
  // One direction of the half vector only: alpha and f0 cannot be told apart.
  Samples samples;
  samples.values.resize(1);
  for (int k = 0; k < 20; ++k) {
    const double value = 0.5 + 0.001 * k;
    samples.Append(FromSpherical(0.1, 0.2), FromSpherical(0.1, 0.2 + kPi), &value, static_cast<std::uint32_t>(k));
  }
  Measurement measurement;
  measurement.samples = samples;
  measurement.channels.names = {"Y"};
  measurement.source = "one direction";
  Recipe recipe =
      DefaultRecipe({{Lobe{Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kSchlick}}, Diffuse::kLambert}, "ggx");
  const Material material = CheckedFit(recipe, {}, &measurement);
  EXPECT_FALSE(material.termination.determined);
  EXPECT_FALSE(material.degenerate.empty());
  // What is named has no error; a tiny one would be believed.
  for (const std::size_t i : {0U, 5U, 6U}) {
    EXPECT_TRUE(std::isnan(material.parameters[i].standard_error[0])) << i;
    EXPECT_TRUE(std::isnan(material.parameters[i].standard_error_clustered[0])) << i;
  }
}

// One sample an incidence, as in pictures of a curved sample: memory is that of the samples, not of samples times
// incidences.
TEST(Fit, EverySampleMayHaveAnIncidenceOfItsOwn) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.3, 0.3, 0, 0, 0);
  const Reflectance reflectance(truth.model, truth.values, truth.channels.size());
  Measurement measurement;
  measurement.channels.names = truth.channels;
  measurement.source = "pairs";
  measurement.samples.values.resize(3);
  constexpr int kPairs = 5000;
  for (int k = 0; k < kPairs; ++k) {
    // A low-discrepancy sequence on both hemispheres [Roberts 2018, R4].
    const auto part = [k](double step) { return std::fmod(0.5 + step * k, 1.0); };
    const Vec3 wi = FromSpherical(std::acos(1 - 0.8 * part(0.8566748838545029)), 2 * kPi * part(0.733891856627126)),
               wo = FromSpherical(std::acos(1 - 0.8 * part(0.6287067210378087)), 2 * kPi * part(0.5385972572236101));
    double f_r[3];
    reflectance.Evaluate(wi, wo, f_r);
    for (double& value : f_r) value *= 1 + 0.05 * std::sin(12.9898 * k);
    measurement.samples.Append(wi, wo, f_r, static_cast<std::uint32_t>(k));
  }
  const Material material = CheckedFit(DefaultRecipe(truth.model, "ggx"), {}, &measurement);
  EXPECT_TRUE(material.termination.determined);
  EXPECT_GT(GroupByIncidence(measurement).wi.size(), 4500U);
  for (const std::size_t i : {0U, 5U, 6U}) {
    const FittedParameter& p = material.parameters[i];
    EXPECT_NEAR(p.standard_error_clustered[0], p.standard_error[0], 0.1 * p.standard_error[0]) << i;
    EXPECT_GT(p.freedom[0], 100) << i;
  }
}

TEST(Fit, SaysThatNoiseAboutZeroAndZeroAreNotAMaterial) {
  for (const double size : {1e-4, 0.0}) {
    Measurement measurement = Synthetic(BrushedMetal(), StandardLayout(), 0, 1);
    double sign = size;
    for (std::vector<double>& values : measurement.samples.values) {
      for (double& value : values) value = sign *= -1;
    }
    const Material material = CheckedFit(AutomaticRecipe(TraitsOf(measurement)), {}, &measurement);
    EXPECT_FALSE(material.termination.determined) << size;
    ASSERT_FALSE(material.degenerate.empty()) << size;
    EXPECT_NE(material.degenerate.back().find("noise about zero"), std::string::npos) << material.degenerate.back();
  }
}

TEST(Fit, SetsAsideAndCounts) {
  Measurement measurement = Synthetic(BrushedMetal(), StandardLayout(), 0, 1);
  const std::size_t before = measurement.samples.size();
  measurement.samples.values[1][3] = -20;
  Recipe recipe = AutomaticRecipe(TraitsOf(measurement));
  recipe.metric = Metric::kLog;  // which has no number for f cos_theta_i <= -1
  recipe.theta_max = DegreesToRadians(50);
  const Material material = CheckedFit(recipe, {}, &measurement);
  EXPECT_GT(material.set_aside.at("beyond_angle_limit"), 0U);
  EXPECT_EQ(material.set_aside.at("negative"), 1U);
  EXPECT_EQ(material.samples_used + material.set_aside.at("beyond_angle_limit") + 1, before);
  EXPECT_EQ(material.samples_read, before);
}

TEST(Fit, RefusesFewerSamplesThanParametersAndNothingLeft) {
  Measurement measurement = Synthetic(BrushedMetal(), StandardLayout(), 0, 1);
  Measurement few = measurement;
  few.samples = measurement.samples.Subset({0, 1, 2});
  EXPECT_THROW(CheckedFit(AutomaticRecipe({}), {}, &few), InputError);
  Recipe narrow = AutomaticRecipe({});
  narrow.theta_max = DegreesToRadians(1);
  EXPECT_THROW(CheckedFit(narrow, {}, &measurement), InputError);
  Recipe weighted = AutomaticRecipe({});
  weighted.weighting = Weighting::kSolidAngle;
  EXPECT_THROW(CheckedFit(weighted, {}, &measurement), InputError);
}

TEST(Fit, InPlaneMeasurementGetsATiltInItsPlaneOnly) {
  for (const double azimuth_deg : {0.0, 35.0}) {
    GoniometerLayout layout = StandardLayout();
    layout.in_plane = true;
    layout.azimuths = {DegreesToRadians(azimuth_deg)};
    layout.detector_step = DegreesToRadians(4);
    const SyntheticCase truth = OneLobe(Ndf::kGgxTilted, 0.2, 0.2, 0, 2, -azimuth_deg);
    Measurement measurement = Synthetic(truth, layout, 0, 1);
    const MeasurementTraits traits = TraitsOf(measurement);
    EXPECT_TRUE(traits.in_plane);
    EXPECT_NEAR(traits.plane_azimuth, DegreesToRadians(azimuth_deg), 1e-9);
    const Material material = CheckedFit(AutomaticRecipe(traits), {}, &measurement);
    EXPECT_EQ(material.model.lobes[0].ndf, Ndf::kGgxTilted);
    ExpectRecovered(material, truth, 1e-8);
  }
}

TEST(Fit, ReportsTheErrorUnderEveryMetric) {
  Measurement measurement = Synthetic(BrushedMetal(), StandardLayout(), 0.05, 1);
  const Material material = CheckedFit(AutomaticRecipe(TraitsOf(measurement)), {}, &measurement);
  // Every one but asinh, which needs the noise.
  ASSERT_EQ(material.errors.size(), MetricChoices().size() - 1);
  for (const MetricError& error : material.errors) {
    EXPECT_NE(error.metric, "asinh");
    // 5 % noise is what is left, under the metric that measures just that.
    if (error.metric == "relative") {
      EXPECT_NEAR(error.rms, 0.05, 0.003);
    }
    if (error.metric == material.metric) {
      const double residuals = static_cast<double>(material.samples_used * material.channels.size());
      EXPECT_NEAR(error.rms, std::sqrt(2 * material.cost / residuals), 1e-12);
    }
  }
}

// The square of hundreds of channels' numbers would make a document of a hundred megabytes.
TEST(Fit, ManyChannelsKeepErrorsAndTheCovarianceOfShapes) {
  SyntheticCase truth =
      OneLobe(Ndf::kGgxAnisotropic, 0.3, 0.15, 0, 0, 20, std::vector<double>(210, 0.5), std::vector<double>(210, 0.1));
  for (std::size_t c = 0; c < truth.channels.size(); ++c) truth.channels[c] = std::to_string(400 + c) + "nm";
  GoniometerLayout layout = StandardLayout();
  layout.polar_angles.resize(2);
  layout.detector_step = DegreesToRadians(30);
  Measurement measurement = Synthetic(truth, layout, 0.03, 1);
  FitOptions options;
  options.starts = 2;
  const Material material = CheckedFit(DefaultRecipe(truth.model, "many"), options, &measurement);
  EXPECT_EQ(material.covariance_names, (std::vector<std::string>{"alpha_x", "alpha_y", "theta_z_deg"}));
  ASSERT_EQ(material.covariance.size(), 9U);
  EXPECT_NEAR(std::sqrt(material.covariance[0]), material.parameters[0].standard_error[0], 1e-15);
  EXPECT_NEAR(std::sqrt(material.covariance[8]), RadiansToDegrees(material.parameters[4].standard_error[0]), 1e-12);
  for (const double error : material.parameters[5].standard_error) EXPECT_GT(error, 0);
  EXPECT_TRUE(material.misfit->tested);
  EXPECT_FALSE(material.misfit->flagged) << material.misfit->probability;
  EXPECT_NE(material.remarks.back().find("the covariance of 423 numbers"), std::string::npos)
      << material.remarks.back();
}

}  // namespace
}  // namespace lobefit
