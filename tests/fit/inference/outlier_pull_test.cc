#include "lobefit/fit/inference/outlier_pull.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/fit/search/solve.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

constexpr double kNoise = 0.02, kFactor = 3;

const SyntheticCase& Truth() {
  static const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.3, 0.3, 0, 0, 0, {0.6}, {0.1});
  return truth;
}

Recipe Robust(Loss loss) {
  Recipe recipe = DefaultRecipe(Truth().model, "robust");
  recipe.metric = Metric::kLog;
  recipe.metric_given = true;
  recipe.loss = loss;
  recipe.loss_scale = 0.05;
  return recipe;
}

// Every `step`-th sample is wrong by a factor: every `below`-th of them too low, the others too high.
struct Spoilt {
  Measurement measurement;
  std::vector<std::uint8_t> right, above;
};
Spoilt Spoil(std::size_t step, std::size_t below) {
  Spoilt spoilt = {Synthetic(Truth(), StandardLayout(), kNoise, 7), {}, {}};
  std::vector<double>& values = spoilt.measurement.samples.values[0];
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool wrong = i % step == 0, low = (i / step) % below == 0;
    if (wrong) values[i] *= low ? 1 / kFactor : kFactor;
    spoilt.right.push_back(wrong ? 0 : 1);
    spoilt.above.push_back(wrong && !low ? 1 : 0);
  }
  return spoilt;
}

struct Fitted {
  std::vector<double> u;
  Uncertainty uncertainty;
  std::optional<OutlierPull> pull;
};
Fitted FitSamples(const Samples& samples, Loss loss) {
  const Recipe recipe = Robust(loss);
  const Layout layout(recipe, {"value"});
  const Problem problem(samples, recipe);
  ThreadPool pool(1);
  std::vector<double> start = layout.FromShapes({{0.3, 0.3, 0, 0, 0}});
  start[static_cast<std::size_t>(layout.linear(0)[0].index)] = 0.6;
  start[static_cast<std::size_t>(layout.linear(0)[1].index)] = 0.1;
  Fitted fitted;
  fitted.u = Solve(problem, layout, start, {}, &pool).u;
  Measurement measurement;
  measurement.samples = samples;
  fitted.uncertainty = EstimateUncertainty(problem, layout, fitted.u, GroupByIncidence(measurement), &pool);
  fitted.pull = PullOfOutliers(problem, layout, fitted.u, fitted.uncertainty, {0, kNoise, 0}, &pool);
  return fitted;
}

// The oracle: the fit without them.
TEST(OutlierPull, IsWhatLeavingThemOutTakesAway) {
  const Spoilt spoilt = Spoil(101, 3);
  const Samples& all = spoilt.measurement.samples;
  const Fitted with = FitSamples(all, Loss::kCauchy);
  ASSERT_TRUE(with.pull.has_value());
  EXPECT_EQ(with.pull->outliers,
            static_cast<std::size_t>(std::count(spoilt.right.begin(), spoilt.right.end(), std::uint8_t{0})));
  EXPECT_EQ(with.pull->parameter, "diffuse");
  const Layout layout(Robust(Loss::kCauchy), {"value"});
  const auto diffuse = static_cast<std::size_t>(layout.linear(0)[1].index);
  const double error = std::sqrt(with.uncertainty.covariance(6, 6));
  const auto without = [&](bool above) {
    Samples kept = all;
    std::vector<std::uint8_t> keep(all.size());
    for (std::size_t i = 0; i < keep.size(); ++i)
      keep[i] = spoilt.right[i] != 0 || (spoilt.above[i] != 0) != above ? 1 : 0;
    kept.Keep(keep);
    return (with.u[diffuse] - FitSamples(kept, Loss::kCauchy).u[diffuse]) / error;
  };
  EXPECT_GT(with.pull->above, 1);
  EXPECT_LT(with.pull->below, -0.1);
  EXPECT_NEAR(with.pull->above, without(true), 0.05 * with.pull->above);
  EXPECT_NEAR(with.pull->below, without(false), 0.05 * with.pull->errors());
}

TEST(OutlierPull, IsToldWhereItIsMuch) {
  const Fitted many = FitSamples(Spoil(31, 2).measurement.samples, Loss::kCauchy);
  const std::string remark = ToPullRemark(many.pull.value(), Loss::kCauchy, 0.05);
  EXPECT_TRUE(IsPullRemark(remark)) << remark;
  EXPECT_NE(remark.find("loss cauchy of scale 0.05"), std::string::npos) << remark;
  EXPECT_GT(many.pull->errors(), 2);

  const Fitted one = FitSamples(Spoil(3000, 1).measurement.samples, Loss::kCauchy);
  EXPECT_LT(one.pull.value().errors(), 2);
  EXPECT_EQ(ToPullRemark(*one.pull, Loss::kCauchy, 0.05), "");
}

TEST(OutlierPull, WithoutALossOrWithoutOutliersThereIsNone) {
  EXPECT_FALSE(FitSamples(Spoil(101, 3).measurement.samples, Loss::kNone).pull.has_value());
  EXPECT_FALSE(FitSamples(Synthetic(Truth(), StandardLayout(), kNoise, 7).samples, Loss::kCauchy).pull.has_value());
}

// Tukey's loss counts what lies beyond its scale for nothing.
TEST(OutlierPull, ThoseThatALossCutsOutPullNothing) {
  const Fitted fitted = FitSamples(Spoil(101, 3).measurement.samples, Loss::kTukey);
  Samples bright = Spoil(101, 3).measurement.samples;
  EXPECT_LT(fitted.pull.value().errors(), FitSamples(bright, Loss::kHuber).pull.value().errors());
}

TEST(OutlierPull, StandsInTheMaterial) {
  Spoilt spoilt = Spoil(31, 2);
  const Material material = CheckedFit(Robust(Loss::kCauchy), {}, &spoilt.measurement);
  EXPECT_EQ(std::count_if(material.remarks.begin(), material.remarks.end(), IsPullRemark), 1);
}

}  // namespace
}  // namespace lobefit
