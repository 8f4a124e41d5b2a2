// Trials that are judged, and trials that are kept in a folder.
#include "lobefit/validate/recovery.h"

#include <cmath>

#include "tests/support/folder_test.h"
#include "tests/validate/brushed.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/validate/trial_store.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Trial Found(double difference) {
  Trial trial;
  trial.done = trial.converged = trial.determined = true;
  trial.difference = difference;
  trial.samples = 100;
  trial.minima = 1;
  return trial;
}

TEST(JudgeRecovery, EachReasonIsNamedAndOnlySilentOnesFail) {
  const Experiment experiment = test::BrushedExperiment("none");
  std::vector<Trial> trials(9, Found(1e-12));
  trials[0].done = false;
  trials[1] = Found(1e-3), trials[1].error = "no sample";
  trials[2] = Found(1e-2), trials[2].degenerate = {"theta_z", "f0 and diffuse"};
  trials[3] = Found(1e-1), trials[3].converged = false;
  trials[4] = Found(2e-1), trials[4].at_bound = {false, true};
  trials[5] = Found(3e-1), trials[5].cost = 50 * 1e-14;  // rms 1e-7
  trials[6] = Found(4e-1), trials[6].cost = 50 * 1e-4, trials[6].minima = 2;
  trials[7] = Found(5e-1), trials[7].cost = 50 * 1e-4, trials[7].misfit = true;
  Recovery recovery = JudgeRecovery(experiment, trials);
  EXPECT_EQ(recovery.trials, 8U);
  EXPECT_EQ(recovery.silent, 0U) << "each gave a sign";
  EXPECT_TRUE(recovery.passed());
  ASSERT_EQ(recovery.exceptions.size(), 7U);
  EXPECT_EQ(recovery.largest, HUGE_VAL) << "a refused one is as far away as can be";
  EXPECT_EQ(recovery.exceptions[0].trial, 1U);
  const char* reasons[] = {"refused: no sample",
                           "a wrong minimum: residuals of 1.0e-02",
                           "a wrong minimum",
                           "the descent ended at residuals of 1.0e-07",
                           "held at its bound",
                           "did not converge",
                           "not determined, and said: theta_z; f0 and diffuse"};
  for (std::size_t k = 0; k < 7; ++k) {
    EXPECT_THAT(recovery.exceptions[k].reason, HasSubstr(reasons[k]));
    EXPECT_EQ(recovery.exceptions[k].trial, k == 0 ? 1 : 8 - k);
  }
  EXPECT_THAT(ToText(recovery, experiment, trials),
              testing::AllOf(HasSubstr("8 materials without noise"), HasSubstr("1 within 1e-08, 7 beyond (0 of these"),
                             HasSubstr("trial 1: inf, refused: no sample")));
  trials[6].minima = 1;
  recovery = JudgeRecovery(experiment, trials);
  EXPECT_EQ(recovery.silent, 1U);
  EXPECT_FALSE(recovery.passed());
}

TEST(JudgeRecovery, LimitsMediansAndNothing) {
  const Experiment experiment = test::BrushedExperiment("none");
  EXPECT_FALSE(JudgeRecovery(experiment, {}).passed()) << "nothing was shown";
  EXPECT_FALSE(JudgeRecovery(experiment, std::vector<Trial>(3)).passed());
  const std::vector<Trial> trials = {Found(3e-5), Found(1e-9), Found(2e-6)};
  const Recovery recovery = JudgeRecovery(experiment, trials, 2e-6);
  EXPECT_EQ(recovery.median, 2e-6);
  EXPECT_EQ(recovery.largest, 3e-5);
  ASSERT_EQ(recovery.exceptions.size(), 1U);
  EXPECT_EQ(recovery.exceptions[0].trial, 0U);
}

// Where fit and truth are not the same model there is no difference: it is none that recovers.
TEST(JudgeRecovery, WhatCannotBeComparedIsNoRecovery) {
  const Experiment experiment = test::BrushedExperiment("none");
  std::vector<Trial> trials;
  for (int k = 0; k < 40; ++k) trials.push_back(Found(k % 2 == 0 ? std::nan("") : 1e-12 * k));
  const Recovery recovery = JudgeRecovery(experiment, trials);
  EXPECT_EQ(recovery.exceptions.size(), 20U);
  EXPECT_EQ(recovery.largest, HUGE_VAL);
  EXPECT_THAT(recovery.exceptions[0].reason, HasSubstr("cannot be compared"));
}

class TrialStoreTest : public FolderTest {};

TEST_F(TrialStoreTest, TrialsComeBackAsTheyWere) {
  Trial trial = Found(1.0 / 3);
  trial.error = "a \"quoted\"\nreason, äö";
  trial.truth = {1, std::nan(""), -0.1};
  trial.value = {1e-300, 2, 3};
  trial.standard_error = {std::nan(""), 0, 1};
  trial.standard_error_clustered = {1, 2, 3};
  trial.freedom = {3.5, HUGE_VAL, 1};
  trial.independent_freedom = {HUGE_VAL};
  trial.free = {true, false, true};
  trial.at_bound = {false, false, true};
  trial.degenerate = {"one", "two"};
  trial.cost = 0.1, trial.cost_at_truth = std::nan("");
  trial.minima = 4, trial.incidences = 12;
  trial.misfit = true, trial.seconds = 0.25;
  {
    TrialStore store(folder_, "key");
    store.Append(3, trial);
    store.Append(0, Found(2));
    store.Append(9, Found(9));
    store.Close();
  }
  const std::vector<Trial> read = TrialStore(folder_, "key").Read(5);
  ASSERT_EQ(read.size(), 5U);
  EXPECT_TRUE(read[0].done && read[3].done);
  EXPECT_FALSE(read[1].done || read[2].done || read[4].done);
  const Trial& again = read[3];
  // The line of a trial holds all of it: equal lines are equal trials, but for infinities, which JSON has not.
  EXPECT_EQ(ToLine("key", 3, again), ToLine("key", 3, trial));
  EXPECT_EQ(again.error, trial.error);
  EXPECT_EQ(again.difference, trial.difference);
  EXPECT_EQ(again.value, trial.value);
  EXPECT_TRUE(std::isnan(again.truth[1]) && std::isnan(again.standard_error[0]) && std::isnan(again.cost_at_truth));
  EXPECT_GT(again.freedom[1], 1e300);
  EXPECT_EQ(again.free, trial.free);
  EXPECT_TRUE(again.misfit && again.converged && !again.biased);
}

// Cut at any byte, as a death leaves it: the trial is there or not, and nothing else is lost.
TEST_F(TrialStoreTest, LinesThatWereCutArePassedOver) {
  const std::string first = ToLine("key", 0, Found(1)), second = ToLine("key", 1, Found(2));
  std::filesystem::create_directories(folder_ / "segments");
  for (std::size_t cut = 0; cut < second.size(); cut += 7) {
    Write("segments/a.jsonl", first + "\n" + second.substr(0, cut));
    const std::vector<Trial> read = TrialStore(folder_, "key").Read(2);
    EXPECT_TRUE(read[0].done) << cut;
    EXPECT_FALSE(read[1].done) << cut;
  }
  Write("segments/a.jsonl", "{\"trial\": \"x\", \"key\": \"key\"}\n[]\n\n" + first + "\n" + second);
  EXPECT_TRUE(TrialStore(folder_, "key").Read(2)[1].done);
}

TEST_F(TrialStoreTest, TrialsOfAnotherValidationAreRefused) {
  {
    TrialStore store(folder_, "one");
    store.Append(0, Found(1));
    store.Close();
  }
  EXPECT_THAT([&] { TrialStore(folder_, "other").Read(1); },
              ThrowsMessage<UsageError>(HasSubstr("holds trials of another validation or version of lobefit")));
}

// All that a trial depends on changes the key; what it does not depend on does not.
TEST(KeyOf, ChangesWithTheExperiment) {
  const Experiment base = test::BrushedExperiment("multiplicative=0.05");
  std::vector<Experiment> others(8, base);
  others[0].truth.values[0][0] += 1e-9;
  others[1].noise.drift = 0.01;
  others[2].seed = 2;
  others[3].fit.starts = 4;
  others[4].recipe.metric = Metric::kRelative;
  others[5].directions.wo[3].x += 1e-12;
  others[6].isotropic = true;
  others[7].turned = true;
  for (const Experiment& other : others) EXPECT_NE(KeyOf(other), KeyOf(base)) << &other - others.data();
  Experiment same = base;
  same.fit.threads = 7;
  EXPECT_EQ(KeyOf(same), KeyOf(base));
}

}  // namespace
}  // namespace lobefit
