#include "lobefit/fit/inference/noise_bias.h"

#include <cmath>
#include <string>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/fit/fit.h"
#include "lobefit/fit/search/solve.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

Measurement Noisy(const SyntheticCase& truth, double noise, std::uint64_t seed) {
  return Synthetic(truth, StandardLayout(), noise, seed);
}

Recipe Under(Metric metric, const SyntheticCase& truth) {
  Recipe recipe = DefaultRecipe(truth.model, "under");
  recipe.metric = metric;
  recipe.metric_given = true;
  return recipe;
}

// What noise of the value does, simulated and predicted.
TEST(NoiseBias, IsThatOfTheMeanOfManyFits) {
  const double noise = 0.1;
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.3, 0.3, 0, 0, 0, {0.6}, {0.1});
  for (const Metric metric : {Metric::kCubeRoot, Metric::kRelative, Metric::kLog, Metric::kCosineL2}) {
    const Recipe recipe = Under(metric, truth);
    const Layout layout(recipe, {"value"});
    constexpr int kTrials = 40;
    std::vector<double> sum(layout.size(), 0), squares(layout.size(), 0), predicted(layout.size(), 0);
    std::vector<double> exact = layout.FromShapes({{0.3, 0.3, 0, 0, 0}});
    exact[static_cast<std::size_t>(layout.linear(0)[0].index)] = 0.6;
    exact[static_cast<std::size_t>(layout.linear(0)[1].index)] = 0.1;
    for (int trial = 0; trial < kTrials; ++trial) {
      const Measurement measurement = Noisy(truth, noise, static_cast<std::uint64_t>(trial));
      const Problem problem(measurement.samples, recipe);
      ThreadPool pool(1);
      const Solution solution = Solve(problem, layout, exact, {}, &pool);
      const Incidences incidences = GroupByIncidence(measurement);
      const Uncertainty uncertainty = EstimateUncertainty(problem, layout, solution.u, incidences, &pool);
      const std::optional<NoiseBias> bias =
          PredictNoiseBias(layout, solution.u, uncertainty, measurement.samples, incidences, &pool);
      ASSERT_TRUE(bias.has_value());
      for (std::size_t k = 0; k < layout.size(); ++k) {
        const double error = solution.u[k] - exact[k];
        sum[k] += error / kTrials;
        squares[k] += error * error / kTrials;
        predicted[k] += bias->moved(static_cast<Eigen::Index>(k)) / kTrials;
      }
    }
    for (std::size_t k = 0; k < layout.size(); ++k) {
      const double of_mean = std::sqrt((squares[k] - sum[k] * sum[k]) / kTrials);
      EXPECT_NEAR(predicted[k], sum[k], 3.5 * of_mean + 0.1 * std::fabs(sum[k]))
          << RowOf(metric).name << " " << layout.coordinates()[k].name;
      if (metric == Metric::kRelative && k > 0) {
        EXPECT_LT(sum[k], -5 * of_mean) << "the test sees a bias where there is one";
      }
    }
  }
}

// The square of the standard error is the variance and the bias squared, and covariances alike.
TEST(NoiseBias, IsPartOfTheErrors) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.3, 0.3, 0, 0, 0, {0.6}, {0.1});
  Measurement measurement = Noisy(truth, 0.1, 1);
  const Recipe recipe = Under(Metric::kRelative, truth);
  const Material material = CheckedFit(recipe, {}, &measurement);
  ASSERT_TRUE(IsBiasRemark(material.remarks.at(0))) << material.remarks[0];
  EXPECT_NE(material.remarks[0].find("noise 10 % of the value"), std::string::npos) << material.remarks[0];
  EXPECT_FALSE(IsBiasRemark("metric log"));

  const Layout layout(recipe, {"value"});
  const Problem problem(measurement.samples, recipe);
  ThreadPool pool(1);
  std::vector<double> u = layout.FromShapes({{material.parameters[0].values[0], material.parameters[0].values[0]}});
  u[static_cast<std::size_t>(layout.linear(0)[0].index)] = material.parameters[5].values[0];
  u[static_cast<std::size_t>(layout.linear(0)[1].index)] = material.parameters[6].values[0];
  const Incidences incidences = GroupByIncidence(measurement);
  const Uncertainty plain = EstimateUncertainty(problem, layout, u, incidences, &pool);
  const std::optional<NoiseBias> bias = PredictNoiseBias(layout, u, plain, measurement.samples, incidences, &pool);
  ASSERT_TRUE(bias.has_value());
  Uncertainty with = plain;
  AddBias(*bias, layout, u, &with);
  const Eigen::VectorXd moved = layout.ReportJacobian(u.data()) * bias->moved;
  for (const Eigen::Index i : {0, 5, 6}) {
    EXPECT_DOUBLE_EQ(with.covariance(i, i), plain.covariance(i, i) + moved(i) * moved(i));
    EXPECT_DOUBLE_EQ(with.covariance(i, 5), plain.covariance(i, 5) + moved(i) * moved(5));
    EXPECT_DOUBLE_EQ(with.clustered(i, 6), plain.clustered(i, 6) + moved(i) * moved(6));
    const FittedParameter& fitted = material.parameters[static_cast<std::size_t>(i)];
    EXPECT_NEAR(fitted.standard_error[0], std::sqrt(with.covariance(i, i)), 1e-6 * fitted.standard_error[0]);
    EXPECT_NEAR(fitted.standard_error_clustered[0], std::sqrt(with.clustered(i, i)),
                1e-6 * fitted.standard_error_clustered[0]);
    EXPECT_GT(fitted.standard_error[0], std::sqrt(plain.covariance(i, i)));
  }
  EXPECT_EQ(with.covariance(2, 2), 0) << "what is fixed has no error";
}

TEST(NoiseBias, OfAMetricWithoutCurveIsNone) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.3, 0.3, 0, 0, 0, {0.6}, {0.1});
  Measurement measurement = Noisy(truth, 0.1, 1);
  const Material material = CheckedFit(Under(Metric::kCosineL2, truth), {}, &measurement);
  for (const std::string& remark : material.remarks) EXPECT_FALSE(IsBiasRemark(remark)) << remark;
}

}  // namespace
}  // namespace lobefit
