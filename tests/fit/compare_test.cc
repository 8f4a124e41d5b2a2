#include "lobefit/fit/compare.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/synthetic.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

Recipe With(const std::vector<Ndf>& ndfs, const std::string& name) {
  Model model;
  for (const Ndf ndf : ndfs) model.lobes.push_back({ndf, Masking::kSmithSeparable, Fresnel::kSchlick});
  return DefaultRecipe(model, name);
}

std::vector<Recipe> OneAndTwoLobes() {
  return {With({Ndf::kGgx, Ndf::kGgx}, "two"), With({Ndf::kGgx}, "one"), With({Ndf::kEllipsoid}, "ellipsoid")};
}

SyntheticCase TwoLobes() {
  SyntheticCase synthetic;
  synthetic.model.lobes.assign(2, {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kSchlick});
  synthetic.values = {{0.05},           {0.05}, {0}, {0}, {0}, {0.05, 0.05, 0.05},
                      {0.35},           {0.35}, {0}, {0}, {0}, {0.3, 0.2, 0.1},
                      {0.1, 0.05, 0.02}};
  return synthetic;
}

std::string Recommended(const Comparison& comparison) { return comparison.models[comparison.recommended].name; }

TEST(Compare, RecommendsTwoLobesWhereThereAreTwo) {
  for (const double noise : {0.0, 0.05}) {
    Measurement measurement = Synthetic(TwoLobes(), StandardLayout(), noise, 3);
    const Comparison comparison = Compare(OneAndTwoLobes(), {}, {}, &measurement);
    EXPECT_EQ(Recommended(comparison), "two") << noise << " " << comparison.reason;
    const JudgedModel &two = comparison.models[0], &one = comparison.models[1];
    EXPECT_LT(two.held_out, 0.5 * one.held_out) << noise;
    EXPECT_LT(two.aic, one.aic) << noise;
    EXPECT_LT(two.bic, one.bic) << noise;
    EXPECT_GT(one.excess, 3 * one.excess_error) << noise;
    EXPECT_THAT(comparison.reason, testing::HasSubstr("no simpler recipe comes within one standard error"));
  }
}

TEST(Compare, RecommendsTheSimplerOfTwoThatPredictAlike) {
  // Isotropic truth: the ellipsoid and the two lobes contain it, and cannot be better.
  for (const double noise : {0.0, 0.05}) {
    for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
      Measurement measurement = Synthetic(OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0), StandardLayout(), noise, seed);
      CompareOptions options;
      options.fit.seed = seed;
      const Comparison comparison =
          Compare({With({Ndf::kEllipsoid}, "ellipsoid"), With({Ndf::kGgx}, "ggx")}, {}, options, &measurement);
      EXPECT_EQ(Recommended(comparison), "ggx") << noise << " seed " << seed << ": " << comparison.reason;
    }
  }
}

TEST(Compare, CriteriaFollowTheirDefinition) {
  Measurement measurement = Synthetic(TwoLobes(), StandardLayout(), 0.05, 3);
  const Comparison comparison = Compare(OneAndTwoLobes(), {}, {}, &measurement);
  for (const JudgedModel& model : comparison.models) {
    const double n = static_cast<double>(comparison.residuals), k = static_cast<double>(model.free_parameters) + 1;
    const double deviance = n * std::log(2 * model.material.cost / n);
    EXPECT_NEAR(model.aic, deviance + 2 * k, 1e-6 * std::fabs(deviance)) << model.name;
    EXPECT_NEAR(model.bic, deviance + k * std::log(n), 1e-6 * std::fabs(deviance)) << model.name;
  }
  // Two shapes and two reflectances and albedos of three channels each.
  EXPECT_EQ(comparison.models[0].free_parameters, 2U + 9U);
  EXPECT_EQ(comparison.models[2].free_parameters, 5U + 6U);
}

TEST(Compare, ErrorsAreThoseOfTheFit) {
  Measurement measurement = Synthetic(TwoLobes(), StandardLayout(), 0.05, 3);
  const Comparison comparison = Compare(OneAndTwoLobes(), {}, {}, &measurement);
  for (const JudgedModel& model : comparison.models) {
    ASSERT_EQ(model.errors.size(), model.material.errors.size());
    for (std::size_t i = 0; i < model.errors.size(); ++i) {
      EXPECT_NEAR(model.errors[i].rms, model.material.errors[i].rms, 1e-10 * model.errors[i].rms) << model.name;
    }
  }
}

TEST(Compare, FoldsKeepIncidencesTogetherAndCoverThemAll) {
  for (const std::size_t incidences : {2, 5, 7, 36}) {
    for (const std::size_t folds : {2, 3, 5}) {
      if (folds > incidences) continue;
      const std::vector<std::size_t> dealt = DealFolds(incidences, folds, 1);
      std::vector<std::size_t> count(folds, 0);
      for (const std::size_t fold : dealt) ++count.at(fold);
      const auto [least, most] = std::minmax_element(count.begin(), count.end());
      EXPECT_LE(*most - *least, 1U);
    }
  }
  EXPECT_NE(DealFolds(36, 5, 1), DealFolds(36, 5, 2));
  EXPECT_EQ(DealFolds(36, 5, 1), DealFolds(36, 5, 1));
}

TEST(Compare, TheErrorOfAHeldOutDirectionComesFromTheOthers) {
  // One direction of 36 is wrong by a factor: it must not draw its own prediction, so the error of its fold shows the
  // whole factor, and the errors of the others hardly change.
  Measurement measurement = Synthetic(OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0), StandardLayout(), 0, 1);
  const Incidences incidences = GroupByIncidence(measurement);
  for (std::size_t i = 0; i < measurement.samples.size(); ++i) {
    if (incidences.group[i] != 7) continue;
    for (std::vector<double>& values : measurement.samples.values) values[i] *= 3;
  }
  CompareOptions options;
  options.folds = 36;
  Recipe recipe = With({Ndf::kGgx}, "ggx");
  recipe.metric = Metric::kRelative;
  const Comparison comparison = Compare({recipe}, {}, options, &measurement);
  const std::vector<double>& folds = comparison.models[0].fold_mean_square;
  ASSERT_EQ(folds.size(), 36U);
  const double worst = *std::max_element(folds.begin(), folds.end());
  EXPECT_NEAR(std::sqrt(worst), 2.0 / 3, 1e-6);
}

TEST(Compare, SameBitsOnOneAndEightThreads) {
  Comparison comparisons[2];
  for (int k = 0; k < 2; ++k) {
    Measurement measurement = Synthetic(TwoLobes(), StandardLayout(), 0.05, 9);
    CompareOptions options;
    options.fit.threads = k == 0 ? 1 : 8;
    options.fold_samples = 3000;
    comparisons[k] = Compare(OneAndTwoLobes(), {}, options, &measurement);
  }
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_EQ(comparisons[0].models[m].fold_mean_square, comparisons[1].models[m].fold_mean_square);
    EXPECT_EQ(comparisons[0].models[m].bic, comparisons[1].models[m].bic);
  }
}

TEST(Compare, OneIncidenceHasNoHeldOutError) {
  GoniometerLayout layout = StandardLayout();
  layout.polar_angles = {DegreesToRadians(40)};
  layout.azimuths = {0};
  layout.detector_step = DegreesToRadians(5);
  Measurement measurement = Synthetic(OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0), layout, 0.05, 1);
  const Comparison comparison = Compare({With({Ndf::kGgx}, "ggx")}, {}, {}, &measurement);
  EXPECT_EQ(comparison.folds, 0U);
  EXPECT_TRUE(std::isnan(comparison.models[0].held_out));
  EXPECT_THAT(comparison.remarks, testing::ElementsAre(testing::HasSubstr("one incident direction")));
  EXPECT_THAT(comparison.reason, testing::HasSubstr("least BIC"));
}

TEST(Compare, GivenMaterialIsJudgedAndNotRecommended) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0);
  Measurement measurement = Synthetic(truth, StandardLayout(), 0.05, 1);
  Material material;
  material.model = truth.model;
  material.channels = measurement.channels.names;
  for (const std::vector<double>& values : truth.values)
    material.parameters.push_back({values, {}, {}, {}, {}, true, false});
  const Comparison comparison = Compare({With({Ndf::kGgx}, "ggx")}, {{"truth", material}}, {}, &measurement);
  ASSERT_EQ(comparison.models.size(), 2U);
  EXPECT_FALSE(comparison.models[1].fitted);
  EXPECT_EQ(comparison.models[1].free_parameters, 0U);
  // The truth is off by the noise alone.
  EXPECT_NEAR(comparison.models[1].errors[2].rms, 0.05, 0.003);
  EXPECT_EQ(comparison.recommended, 0U);
  material.channels = {"Y"};
  EXPECT_THROW(Compare({With({Ndf::kGgx}, "ggx")}, {{"grey", material}}, {}, &measurement), InputError);
  // Before the fits: that of two samples is an error of its own.
  measurement.samples = measurement.samples.Subset({0, 1});
  EXPECT_THAT([&] { Compare({With({Ndf::kGgx}, "ggx")}, {{"grey", material}}, {}, &measurement); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("grey: has 1 channels")));
}

TEST(Compare, AllRecipesAreJudgedOnTheSameSamples) {
  Measurement measurement = Synthetic(TwoLobes(), StandardLayout(), 0, 1);
  Recipe narrow = With({Ndf::kGgx}, "narrow"), wide = With({Ndf::kGgx}, "wide");
  narrow.theta_max = DegreesToRadians(50);
  const Comparison comparison = Compare({wide, narrow}, {}, {}, &measurement);
  EXPECT_EQ(comparison.models[0].material.samples_used, comparison.models[1].material.samples_used);
  EXPECT_NEAR(comparison.theta_max, DegreesToRadians(50), 1e-12);
  EXPECT_LT(comparison.samples, comparison.samples_read);
}

}  // namespace
}  // namespace lobefit
