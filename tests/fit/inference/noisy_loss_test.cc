#include "lobefit/fit/inference/noisy_loss.h"

#include <cmath>
#include <vector>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/fit/fit.h"
#include "lobefit/fit/inference/noise_bias.h"
#include "lobefit/fit/search/solve.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/synthesis/random.h"

namespace lobefit {
namespace {

struct Sum {
  double mean = 0, of_mean = 0;  // and its standard error
};
Sum MeanOf(const std::vector<double>& x) {
  Sum sum;
  for (const double value : x) sum.mean += value / static_cast<double>(x.size());
  for (const double value : x) sum.of_mean += (value - sum.mean) * (value - sum.mean);
  sum.of_mean = std::sqrt(sum.of_mean) / static_cast<double>(x.size());
  return sum;
}

// Few counts and many, with and without a floor, one channel and two, against drawn readings.
TEST(NoisyLoss, MeansAreThoseOfDrawnReadings) {
  const struct {
    Metric metric;
    Loss loss;
    double scale;
    NoiseModel noise;
    std::vector<double> v;
  } cases[] = {
      {Metric::kCosineL2, Loss::kCauchy, 0.002, {0, 0, 0.001}, {0.006}},
      {Metric::kAsinh, Loss::kHuber, 0.05, {0.001, 0.02, 0.001}, {0.02}},
      {Metric::kLog, Loss::kCauchy, 0.002, {0.0005, 0.02, 0.001}, {0.025}},
      {Metric::kCubeRoot, Loss::kCauchy, 0.02, {0, 0.1, 0}, {0.4}},
      {Metric::kRelative, Loss::kCauchy, 0.05, {0, 0.02, 0}, {0.4}},
      {Metric::kCosineL2, Loss::kCauchy, 0.003, {0, 0, 0.001}, {0.006, 0.012}},
  };
  constexpr int kDraws = 200000;
  for (const auto& c : cases) {
    const Transform transform = TransformOf(c.metric, c.noise);
    constexpr double kRoot = 1.3;
    RandomNumbers random(3);
    std::vector<std::vector<double>> scores(c.v.size()), curvatures(c.v.size());
    for (int draw = 0; draw < kDraws; ++draw) {
      std::vector<double> r, s;
      double squares = 0;
      for (const double v : c.v) {
        const double floor = c.noise.floor * random.Normal(), relative = c.noise.relative * v * random.Normal();
        const double counted = c.noise.poisson > 0 ? c.noise.poisson * random.Poisson(v / c.noise.poisson) : v;
        const double m = counted + floor + relative, one = 1;
        r.push_back(0);
        s.push_back(c.metric == Metric::kRelative ? v / m : 1.0);
        Residuals(transform, &v, &one, &m, &kRoot, 1, &r.back(), nullptr);
        squares += r.back() * r.back();
      }
      const LossValue rho = EvaluateLoss(c.loss, c.scale, squares);
      for (std::size_t k = 0; k < r.size(); ++k) {
        scores[k].push_back(rho.first * r[k] * s[k]);
        curvatures[k].push_back((rho.first + 2 * rho.second * r[k] * r[k]) * s[k] * s[k]);
      }
    }
    const std::vector<MeanScore> means = NoisyLoss(transform, c.loss, c.scale, c.noise).Evaluate(c.v, kRoot);
    ASSERT_EQ(means.size(), c.v.size());
    for (std::size_t k = 0; k < c.v.size(); ++k) {
      const Sum score = MeanOf(scores[k]), curvature = MeanOf(curvatures[k]);
      // Another channel's squares enter by their mean.
      const double part = c.v.size() > 1 ? 0.35 : 0.0;
      EXPECT_NEAR(means[k].score, score.mean, 4 * score.of_mean + part * std::fabs(score.mean)) << RowOf(c.metric).name;
      // That of Huber's loss jumps, which a quadrature of some hundred readings sees to some hundredths.
      const double of_jump = c.loss == Loss::kHuber ? 0.05 : 0.0;
      EXPECT_NEAR(means[k].curvature, curvature.mean, 4 * curvature.of_mean + (part + of_jump) * curvature.mean)
          << RowOf(c.metric).name;
      EXPECT_GT(std::fabs(score.mean), 3 * score.of_mean) << "there is something to see";
    }
  }
}

TEST(NoisyLoss, EvenNoiseAboutAStraightMetricMovesNothing) {
  const NoiseModel noise = {0.01, 0.1, 0};
  for (const Loss loss : {Loss::kHuber, Loss::kCauchy, Loss::kTukey}) {
    const MeanScore mean = NoisyLoss({Curve::kLinear}, loss, 0.03, noise).Evaluate({0.5}, 1).at(0);
    EXPECT_NEAR(mean.score, 0, 1e-15);
    EXPECT_GT(mean.curvature, 0);
    EXPECT_LT(mean.curvature, 1);
  }
}

Measurement Counted(const SyntheticCase& truth, double one_count, std::uint64_t seed) {
  const Reflectance reflectance(truth.model, truth.values, truth.channels.size());
  Noise noise;
  noise.poisson = one_count;
  Measurement measurement = Synthesise(
      Goniometer(StandardLayout()), {truth.channels, {}},
      [&](const Vec3& wi, const Vec3& wo, double* f_r) { reflectance.Evaluate(wi, wo, f_r); }, noise, seed);
  measurement.source = "counted";
  return measurement;
}

// What counting noise does to fits with a loss under a metric that bends nothing, simulated and predicted.
TEST(NoiseBias, OfALossIsThatOfTheMeanOfManyFits) {
  const SyntheticCase truth = OneLobe(Ndf::kGgx, 0.3, 0.3, 0, 0, 0, {0.6}, {0.1});
  Recipe recipe = DefaultRecipe(truth.model, "robust");
  recipe.metric = Metric::kCosineL2;
  recipe.metric_given = true;
  recipe.loss = Loss::kCauchy;
  recipe.loss_scale = 0.01;
  const Layout layout(recipe, {"value"});
  const auto diffuse = static_cast<std::size_t>(layout.linear(0)[1].index);
  std::vector<double> exact = layout.FromShapes({{0.3, 0.3, 0, 0, 0}});
  exact[static_cast<std::size_t>(layout.linear(0)[0].index)] = 0.6;
  exact[diffuse] = 0.1;
  constexpr int kTrials = 40;
  ThreadPool pool(1);
  std::vector<std::vector<double>> errors(layout.size());
  std::vector<double> predicted(layout.size(), 0);
  double plain_error = 0;  // of trial 1, that of the diffuse part
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const Measurement measurement = Counted(truth, 0.005, trial);
    const Problem problem(measurement.samples, recipe);
    const Solution solution = Solve(problem, layout, exact, {}, &pool);
    const Incidences incidences = GroupByIncidence(measurement);
    const Uncertainty uncertainty = EstimateUncertainty(problem, layout, solution.u, incidences, &pool);
    if (trial == 1) plain_error = std::sqrt(uncertainty.covariance(6, 6));
    const std::optional<NoiseBias> bias =
        PredictNoiseBias(layout, solution.u, uncertainty, measurement.samples, incidences, &pool);
    ASSERT_TRUE(bias.has_value());
    for (std::size_t k = 0; k < layout.size(); ++k) {
      errors[k].push_back(solution.u[k] - exact[k]);
      predicted[k] += bias->moved(static_cast<Eigen::Index>(k)) / kTrials;
    }
  }
  for (std::size_t k = 0; k < layout.size(); ++k) {
    const Sum error = MeanOf(errors[k]);
    // The estimated noise of a count is right to some tenths.
    EXPECT_NEAR(predicted[k], error.mean, 3.5 * error.of_mean + 0.3 * std::fabs(error.mean))
        << layout.coordinates()[k].name;
  }
  const Sum error = MeanOf(errors[diffuse]);
  EXPECT_LT(error.mean, -5 * error.of_mean) << "few counts are skewed";
  EXPECT_LT(predicted[diffuse], 0.5 * error.mean);

  Measurement measurement = Counted(truth, 0.005, 1);
  const Material material = CheckedFit(recipe, {}, &measurement);
  bool named = false;
  for (const std::string& remark : material.remarks)
    named = named || (IsBiasRemark(remark) && remark.starts_with("loss cauchy of metric cosine-l2 is biased"));
  EXPECT_TRUE(named);
  EXPECT_GT(material.parameters[6].standard_error[0], 1.1 * plain_error) << "the errors hold the bias";
}

}  // namespace
}  // namespace lobefit
