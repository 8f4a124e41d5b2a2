#include "lobefit/fit/sel/fit.h"

#include <cmath>
#include <random>

#include "tests/support/synthetic.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/core/brdf/brdf.h"
#include "lobefit/core/sel/sel.h"
#include "lobefit/fit/compare.h"
#include "lobefit/fit/objective/prediction.h"
#include "lobefit/fit/sel/envelope.h"
#include "lobefit/fit/sel/sampling.h"
#include "lobefit/fit/sel/slice.h"
#include "lobefit/material/json.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

Recipe SelRecipeOf(std::size_t lobes, bool bound = false) {
  Model model;
  model.diffuse = Diffuse::kNone;
  Recipe recipe = DefaultRecipe(model, "sel");
  recipe.metric = Metric::kLog;
  recipe.sel = SelRecipe{lobes, SelQuantity::kBrdfCosineO, bound, 3};
  return recipe;
}

GoniometerLayout FewIncidences() {
  GoniometerLayout layout;
  for (const double degrees : {0., 20., 40., 60.}) layout.polar_angles.push_back(DegreesToRadians(degrees));
  layout.azimuths = {0, DegreesToRadians(90)};
  layout.detector_step = DegreesToRadians(8);
  return layout;
}

// Lobes that change smoothly with the incidence; two channels.
SelTable Truth(std::size_t lobes) {
  SelTable table;
  for (const double theta : {0., 20., 40., 60.}) {
    for (const double phi : {0., 90.}) {
      if (theta == 0 && phi > 0) continue;
      SelSlice slice;
      slice.theta_i = DegreesToRadians(theta);
      slice.phi_i = DegreesToRadians(phi);
      slice.lobes.push_back({0.25, 0.15 - 0.001 * theta, 0.002 * theta, 0.01, 0.5});
      slice.amplitude.push_back({1.5 + 0.01 * theta, 1});
      if (lobes > 1) {
        slice.lobes.push_back({0.7, 0.6, 0, 0, 0.5});
        slice.amplitude.push_back({0.2, 0.4});
      }
      slice.constant = {0.05, 0.02};
      table.slices.push_back(slice);
    }
  }
  return table;
}

Measurement MeasurementOf(const SelTable& table, double noise) {
  const SelReflectance reflectance(table);
  Measurement measurement = Synthesise(
      Goniometer(FewIncidences()), {{"A", "B"}, {}},
      [&](const Vec3& wi, const Vec3& wo, double* f_r) { reflectance.Evaluate(wi, wo, f_r); }, {noise, 0}, 1);
  measurement.source = "lobes";
  return measurement;
}

double ErrorUnder(const Material& material, const std::string& metric) {
  for (const MetricError& error : material.errors) {
    if (error.metric == metric) return error.rms;
  }
  return std::nan("");
}

// A value far from every other must not be fitted by a lobe that is brighter than any sample and passes between them.
TEST(FitSel, NoLobeHidesBetweenTheSamples) {
  const SelTable truth = Truth(1);
  Measurement measurement = MeasurementOf(truth, 0.2);
  const Material material = FitSel(SelRecipeOf(3), {}, &measurement);
  double brightest = 0;
  for (std::size_t i = 0; i < measurement.samples.size(); ++i) {
    brightest = std::max(brightest, measurement.samples.values[0][i] * measurement.samples.wo_z[i]);
  }
  for (const SelSlice& slice : material.sel->slices) {
    for (const std::vector<double>& amplitude : slice.amplitude) EXPECT_LE(amplitude[0], 4 * brightest * (1 + 1e-12));
  }
  EXPECT_THAT(material.remarks, testing::Contains(testing::HasSubstr("have a lobe at the limit")));
}

// A table that has one side of the plane of incidence only, as those over half and difference angles.
TEST(FitSel, LobesOfAnIsotropicTableDoNotLeanToTheSideThatItHas) {
  Material truth;
  truth.model.lobes = {{Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kNone, ""}};
  truth.model.diffuse = Diffuse::kNone;
  const Reflectance reflectance(truth.model, {{0.3}, {0.3}, {0}, {0}, {0}, {1, 1}}, 2);
  GoniometerLayout layout = FewIncidences();
  layout.azimuths = {0};
  const DirectionList all = Goniometer(layout);
  DirectionList half;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all.wo[i].y >= 0) half.Add(all.wi[i], all.wo[i]);
  }
  Measurement measurement = Synthesise(
      half, {{"A", "B"}, {}}, [&](const Vec3& wi, const Vec3& wo, double* f_r) { reflectance.Evaluate(wi, wo, f_r); },
      {}, 1);
  measurement.isotropic = true;
  const Material material = FitSel(SelRecipeOf(1), {}, &measurement);
  const SelReflectance fitted(*material.sel);
  for (std::size_t i = 0; i < all.size(); ++i) {
    double value[2], image[2];
    fitted.Evaluate(all.wi[i], all.wo[i], value);
    fitted.Evaluate(all.wi[i], {all.wo[i].x, -all.wo[i].y, all.wo[i].z}, image);
    // The descent stops at changes of 1e-7 of the objective, which leaves lobes turned by some thousandths.
    ASSERT_NEAR(image[0] / value[0], 1, 5e-3) << i;
  }
}

TEST(FitSel, RecoversATableOfLobes) {
  for (const std::size_t lobes : {1, 2}) {
    const SelTable truth = Truth(lobes);
    Measurement measurement = MeasurementOf(truth, 0);
    const Material material = FitSel(SelRecipeOf(lobes), {}, &measurement);
    EXPECT_TRUE(material.termination.converged) << material.termination.message;
    ASSERT_EQ(material.sel->slices.size(), truth.slices.size());
    EXPECT_THAT(material.remarks, testing::IsEmpty());
    EXPECT_LT(ErrorUnder(material, "relative"), lobes == 1 ? 1e-6 : 1e-4) << lobes;
    if (lobes > 1) continue;
    for (const SelSlice& slice : material.sel->slices) {
      for (const SelSlice& expected : truth.slices) {
        if (std::fabs(expected.theta_i - slice.theta_i) > 1e-6 || std::fabs(expected.phi_i - slice.phi_i) > 1e-6)
          continue;
        EXPECT_NEAR(slice.lobes[0].alpha_x, expected.lobes[0].alpha_x, 1e-5);
        EXPECT_NEAR(slice.lobes[0].alpha_y, expected.lobes[0].alpha_y, 1e-5);
        EXPECT_NEAR(slice.lobes[0].offset_in, expected.lobes[0].offset_in, 1e-5);
        EXPECT_NEAR(std::remainder(slice.lobes[0].psi - expected.lobes[0].psi, kPi), 0, 1e-4);
        EXPECT_NEAR(slice.amplitude[0][1], expected.amplitude[0][1], 1e-5);
      }
    }
  }
}

TEST(FitSel, RoundLobesStayOnTheirSideOfTheKink) {
  SelTable truth = Truth(1);
  for (SelSlice& slice : truth.slices) slice.lobes[0] = {0.2, 0.2, 0, 0, 0};
  Measurement measurement = MeasurementOf(truth, 0.03);
  const Material material = FitSel(SelRecipeOf(1), {}, &measurement);
  EXPECT_TRUE(material.termination.converged);
  for (const SelSlice& slice : material.sel->slices) {
    EXPECT_GE(slice.lobes[0].alpha_x, slice.lobes[0].alpha_y);
    EXPECT_NEAR(slice.lobes[0].alpha_x, 0.2, 0.02);
    EXPECT_NEAR(slice.lobes[0].alpha_y, 0.2, 0.02);
  }
}

TEST(FitSel, SmallDriftIsSmoother) {
  double variation[2];
  for (int k = 0; k < 2; ++k) {
    Measurement measurement = MeasurementOf(Truth(1), 0.3);
    Recipe recipe = SelRecipeOf(1);
    recipe.sel->drift = k == 0 ? 0.05 : 100;
    const Material material = FitSel(recipe, {}, &measurement);
    variation[k] = 0;
    for (std::size_t s = 1; s < material.sel->slices.size(); ++s) {
      const double step =
          std::log(material.sel->slices[s].lobes[0].alpha_x / material.sel->slices[s - 1].lobes[0].alpha_x);
      variation[k] += step * step;
    }
  }
  EXPECT_LT(variation[0], 0.5 * variation[1]);
}

TEST(FitSel, BoundLiesOnOrAboveEverySampleAlsoAfterWriting) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.3, 0.12, 0, 3, 25);
  for (const std::size_t lobes : {1, 2}) {
    for (const SelQuantity quantity : {SelQuantity::kBrdf, SelQuantity::kBrdfCosineO}) {
      Measurement measurement = Synthetic(truth, FewIncidences(), 0.1, 2);
      Recipe recipe = SelRecipeOf(lobes, true);
      recipe.sel->quantity = quantity;
      const Material fitted = FitSel(recipe, {}, &measurement);
      ThreadPool pool(1);
      for (const Material& material : {fitted, MaterialFromJson(ToJson(fitted), "document")}) {
        const std::vector<std::vector<double>> f_r = Predict(material, measurement.samples, &pool);
        std::size_t touching = 0;
        for (std::size_t c = 0; c < f_r.size(); ++c) {
          for (std::size_t i = 0; i < measurement.samples.size(); ++i) {
            ASSERT_GE(f_r[c][i], measurement.samples.values[c][i]) << c << " " << i;
            touching += f_r[c][i] < measurement.samples.values[c][i] * (1 + 1e-6) ? 1 : 0;
          }
        }
        // It rests on samples in every slice and channel: it is not just high.
        EXPECT_GE(touching, material.sel->slices.size() * f_r.size());
      }
    }
  }
}

SelSamples RandomSamples(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  SelSamples samples;
  samples.f_r.resize(1);
  for (int i = 0; i < 200; ++i) {
    const Vec3 v = FromSpherical(1.2 * uniform(random), 2 * kPi * uniform(random));
    samples.v.push_back(v);
    samples.cos_i.push_back(0.8);
    samples.cos_o.push_back(0.5);
    samples.weight.push_back(1);
    samples.f_r[0].push_back((0.1 + Ssl(0.2, std::acos(v.z))) * (0.5 + uniform(random)));
  }
  return samples;
}

TEST(LeastBound, NoFeasibleAmplitudesCostLess) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SelSamples samples = RandomSamples(seed);
    SelSlice shapes;
    shapes.lobes = {{0.15, 0.15, 0, 0, 0}, {0.5, 0.3, 0.1, 0, 1}};
    const SelSlice bound = LeastBound(samples, SelQuantity::kBrdf, shapes);
    const SelLobeInFrame first(shapes.lobes[0]), second(shapes.lobes[1]);
    const auto worst_share = [&](double a, double b, double c) {
      double worst = 0;
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const double g = a * first.Evaluate(samples.v[i], nullptr) + b * second.Evaluate(samples.v[i], nullptr) + c;
        worst = std::max(worst, samples.f_r[0][i] / g);
      }
      return worst;
    };
    EXPECT_LE(worst_share(bound.amplitude[0][0], bound.amplitude[1][0], bound.constant[0]), 1 + 1e-8);
    const double integral = SelSliceIntegral(bound);
    for (int k = 0; k < 2000; ++k) {
      // Any other direction of amplitudes, scaled until it bounds.
      const double spread = k % 2 == 0 ? 1.0 : 0.05;
      const double a = std::max(0.0, bound.amplitude[0][0] + spread * (uniform(random) - 0.5));
      const double b = std::max(0.0, bound.amplitude[1][0] + spread * (uniform(random) - 0.5));
      const double c = std::max(1e-6, bound.constant[0] + spread * (uniform(random) - 0.5));
      const double scale = worst_share(a, b, c);
      SelSlice other = bound;
      other.amplitude = {{scale * a}, {scale * b}};
      other.constant = {scale * c};
      EXPECT_GE(SelSliceIntegral(other), integral * (1 - 1e-8)) << seed << " " << k;
    }
  }
}

TEST(BoundSelSlice, IsTighterThanAFitThatIsRaised) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SelSamples samples = RandomSamples(seed);
    SelSliceOptions options;
    options.quantity = SelQuantity::kBrdf;
    const SelSlice fit = SearchSelSlice(samples, 0.5, 1, options).slice;
    const SelSlice bound = BoundSelSlice(samples, SelQuantity::kBrdf, fit);
    EXPECT_LT(SelSliceIntegral(bound), SelSliceIntegral(LeastBound(samples, SelQuantity::kBrdf, fit)) * (1 + 1e-9));
  }
}

TEST(FitSel, SameBitsOnOneAndEightThreads) {
  std::string documents[2];
  for (int k = 0; k < 2; ++k) {
    Measurement measurement = MeasurementOf(Truth(2), 0.05);
    FitOptions options;
    options.threads = k == 0 ? 1 : 8;
    Material material = FitSel(SelRecipeOf(2), options, &measurement);
    material.timings_s.clear();
    documents[k] = ToJson(material);
  }
  EXPECT_EQ(documents[0], documents[1]);
}

TEST(FitSel, DocumentReadsBackTheSameTable) {
  Measurement measurement = MeasurementOf(Truth(2), 0.05);
  const Material material = FitSel(SelRecipeOf(2), {}, &measurement);
  const Material read = MaterialFromJson(ToJson(material), "document");
  ThreadPool pool(1);
  const auto a = Predict(material, measurement.samples, &pool), b = Predict(read, measurement.samples, &pool);
  for (std::size_t i = 0; i < a[0].size(); ++i) EXPECT_NEAR(a[0][i], b[0][i], 1e-12 * a[0][i]);
}

TEST(FitSel, SaysWhatIsMissing) {
  Measurement measurement = MeasurementOf(Truth(1), 0);
  std::vector<std::size_t> few;
  for (std::size_t i = 0; i < measurement.samples.size(); i += 60) few.push_back(i);
  measurement.samples = measurement.samples.Subset(few);
  EXPECT_THROW(FitSel(SelRecipeOf(3), {}, &measurement), InputError);
}

TEST(FitSel, FollowsAModel) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0, {0.5}, {0.1});
  Material material;
  material.model = truth.model;
  material.channels = {"Y"};
  for (const std::vector<double>& values : truth.values)
    material.parameters.push_back({values, {}, {}, {}, {}, true, false});
  Measurement measurement = SampleForSel(material);
  EXPECT_TRUE(measurement.isotropic);
  const Material lobes = FitSel(SelRecipeOf(2), {}, &measurement);
  EXPECT_LT(ErrorUnder(lobes, "log"), 0.02);
}

TEST(Compare, ShowsTheErrorOfLobesBesideAModelAndRecommendsTheModel) {
  Measurement measurement = Synthetic(OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0), FewIncidences(), 0.02, 1);
  Model model;
  model.lobes = {{Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kSchlick}};
  Recipe ggx = DefaultRecipe(model, "ggx");
  ggx.metric = Metric::kLog;
  CompareOptions options;
  options.folds = 3;
  const Comparison comparison = Compare({SelRecipeOf(1), ggx}, {}, options, &measurement);
  EXPECT_EQ(comparison.recommended, 1U);
  EXPECT_EQ(comparison.models[0].free_parameters, 7U * SelFreeParameters(1, 3));
  EXPECT_TRUE(std::isfinite(comparison.models[0].held_out));
}

}  // namespace
}  // namespace lobefit
