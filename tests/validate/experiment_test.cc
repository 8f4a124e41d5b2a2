#include "lobefit/validate/experiment.h"

#include <cmath>

#include "tests/validate/brushed.h"
#include <gtest/gtest.h>

#include "lobefit/validate/calibration.h"
#include "lobefit/validate/sweep.h"

namespace lobefit {
namespace {

// The sweep is about it: a fit that turned to another would show nothing of it.
TEST(Sweep, AMetricThatIsSweptIsGiven) {
  ExperimentRequest request;
  request.recipe = DefaultRecipe(test::BrushedMetal().model, "test");
  const Sweep sweep = ParseSweep("metric=cube-root,log", request);
  EXPECT_EQ(sweep.points.at(0).request.recipe.metric, Metric::kCubeRoot);
  EXPECT_TRUE(sweep.points[0].request.recipe.metric_given);
  EXPECT_TRUE(sweep.points.at(1).request.recipe.metric_given);
}

// Where the metric is bent by the noise the fits say so, and the calibration counts it.
TEST(Calibration, CountsFitsThatNameTheBiasOfTheirMetric) {
  Experiment experiment = test::BrushedExperiment("multiplicative=0.1");
  experiment.recipe.metric_given = true;
  for (const Metric metric : {Metric::kRelative, Metric::kCosineL2}) {
    experiment.recipe.metric = metric;
    const Calibration calibration = Calibrate(experiment, test::Run(experiment, 4));
    EXPECT_EQ(calibration.biased.count, metric == Metric::kRelative ? 4U : 0U);
    EXPECT_EQ(calibration.biased.total, 4U);
    EXPECT_EQ(TableOf(calibration).find("bias of the metric named") != std::string::npos, metric == Metric::kRelative);
  }
}

TEST(Experiment, TrialsDoNotDependOnThreadsOrOnHowManyThereAre) {
  Experiment experiment = test::BrushedExperiment("multiplicative=0.05,drift=0.02");
  experiment.range = MaterialRange{};
  const std::vector<Trial> one = test::Run(experiment, 6, 1), three = test::Run(experiment, 9, 3);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].value, three[i].value) << i;
    EXPECT_EQ(one[i].truth, three[i].truth) << i;
    EXPECT_EQ(one[i].standard_error.size(), three[i].standard_error.size());
    EXPECT_EQ(one[i].cost, three[i].cost);
  }
  EXPECT_NE(one[0].truth, one[1].truth);
  experiment.seed = 2;
  EXPECT_NE(test::Run(experiment, 1)[0].value, one[0].value);
}

// What all trials measure before their noise is made once, unless a trial draws its material or how the sample stands.
TEST(Experiment, ATrialOfManyIsTheOneAlone) {
  for (const char* noise : {"multiplicative=0.05,drift=0.02,aperture=1", "multiplicative=0.05,misalignment=0.2"}) {
    const Experiment experiment = test::BrushedExperiment(noise);
    const std::vector<Trial> trials = test::Run(experiment, 2);
    for (std::size_t i = 0; i < trials.size(); ++i) EXPECT_EQ(trials[i].value, RunTrial(experiment, i).value) << noise;
  }
}

TEST(Experiment, NoiseFreeTrialsRecoverTheTruth) {
  const Trial trial = RunTrial(test::BrushedExperiment("none"), 0);
  EXPECT_TRUE(trial.converged);
  EXPECT_LT(trial.difference, 1e-8);
  for (std::size_t e = 0; e < trial.value.size(); ++e)
    EXPECT_NEAR(trial.value[e], trial.truth[e], 1e-6 * std::fabs(trial.truth[e]) + 1e-6);
  EXPECT_NEAR(trial.cost_at_truth, 0, 1e-20);
}

TEST(Experiment, CostOfTheTruthIsThatOfTheNoiseAndTheFitIsNotWorse) {
  const Experiment experiment = test::BrushedExperiment("multiplicative=0.05");
  for (std::size_t i = 0; i < 3; ++i) {
    const Trial trial = RunTrial(experiment, i);
    EXPECT_LE(trial.cost, trial.cost_at_truth * (1 + 1e-9));
    // The fit takes up as many residuals as it has parameters.
    EXPECT_GT(trial.cost, 0.97 * trial.cost_at_truth);
  }
}

// What a measurement draws once differs from trial to trial and comes again with the trial.
TEST(Experiment, AMisalignmentIsDrawnForEachTrial) {
  const Noise wanted = ParseNoise("misalignment=0.2");
  const Noise one = DrawnNoise(wanted, 1), two = DrawnNoise(wanted, 2);
  EXPECT_EQ(one.misalignment, 0);
  EXPECT_EQ(one.misalignment_x, DrawnNoise(wanted, 1).misalignment_x);
  EXPECT_NE(one.misalignment_x, two.misalignment_x);
  double squares = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Noise drawn = DrawnNoise(wanted, seed);
    squares += drawn.misalignment_x * drawn.misalignment_x + drawn.misalignment_y * drawn.misalignment_y;
  }
  EXPECT_NEAR(std::sqrt(squares / 800) * 180 / kPi, 0.2, 0.02);
}

// Turned by half on its stage, a sample that stands crooked is fitted from both files without an error, if the
// alignment is fitted.
TEST(Experiment, ATurnedSampleIsASecondFile) {
  Experiment experiment = test::BrushedExperiment("misalignment-x=0.3,misalignment-y=-0.2");
  experiment.turned = true;
  experiment.recipe.instrument.alignment = AlignmentRecipe();
  const Trial both = RunTrial(experiment, 0);
  EXPECT_TRUE(both.converged);
  EXPECT_EQ(both.samples, 2 * RunTrial(test::BrushedExperiment("none"), 0).samples);
  for (std::size_t e = 0; e < both.value.size(); ++e)
    EXPECT_NEAR(both.value[e], both.truth[e], 1e-3 * std::fabs(both.truth[e]) + 1e-3) << e;
}

TEST(Experiment, AnotherModelIsComparedByNamesOnly) {
  Experiment experiment = test::BrushedExperiment("none");
  Model two = experiment.truth.model;
  two.lobes[0].masking = Masking::kSmithHeight;
  experiment.recipe = DefaultRecipe(two, "height");
  const Trial trial = RunTrial(experiment, 0);
  EXPECT_TRUE(std::isnan(trial.cost_at_truth));
  EXPECT_TRUE(std::isnan(trial.difference));
  EXPECT_NEAR(trial.truth[0], 0.35, 1e-12);
  EXPECT_NEAR(trial.value[0], 0.35, 0.1);
}

TEST(Experiment, AStoppedRunKeepsWhatItHas) {
  std::atomic<bool> stop{false};
  std::atomic<int> count{0};
  const std::vector<Trial> trials = RunTrials(
      test::BrushedExperiment("none"), 20, 1,
      [&] {
        if (++count == 3) stop = true;
      },
      stop);
  ASSERT_EQ(trials.size(), 20U);
  for (std::size_t i = 0; i < trials.size(); ++i) EXPECT_EQ(trials[i].done, i < 3) << i;
}

TEST(Experiment, AMeasurementThatCannotBeFittedIsKeptAsRefused) {
  Experiment experiment = test::BrushedExperiment("none");
  experiment.recipe.theta_max = 0.01;
  const Trial trial = RunTrial(experiment, 0);
  EXPECT_TRUE(trial.done);
  EXPECT_NE(trial.error, "");
}

}  // namespace
}  // namespace lobefit
