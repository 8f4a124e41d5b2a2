#include "lobefit/validate/self_check.h"

#include <algorithm>

#include <fmt/format.h>

#include "lobefit/validate/recovery.h"
#include "lobefit/validate/sweep.h"

namespace lobefit {
namespace {

// A brushed metal at 7 x 3 light directions.
ExperimentRequest Base() {
  ExperimentRequest request;
  request.truth.model.lobes.resize(1);
  request.truth.values = {{0.35}, {0.11}, {0}, {DegreesToRadians(3)}, {DegreesToRadians(25)}, {0.7}, {0.02}};
  request.truth.channels = {"Y"};
  for (const double degrees : {5., 20., 30., 40., 50., 60., 70.})
    request.layout.goniometer.polar_angles.push_back(DegreesToRadians(degrees));
  for (const double degrees : {0., 60., 120.}) request.layout.goniometer.azimuths.push_back(DegreesToRadians(degrees));
  request.layout.goniometer.detector_step = DegreesToRadians(15);
  request.recipe = DefaultRecipe(request.truth.model, "self-check");
  request.recipe.metric = Metric::kLog;
  return request;
}

SelfCheckLine LineOf(const std::string& what, const Calibration& c) {
  double low = 1, high = 0;
  for (const EntryCalibration& entry : c.entries) {
    const Share& share = (c.judge_clustered ? entry.clustered : entry.independent).within_95;
    low = std::min(low, share.value);
    high = std::max(high, share.value);
  }
  SelfCheckLine line = {
      what, fmt::format("{} fits; 95 % intervals hold the truth in {:.1f} to {:.1f} %", c.done, 100 * low, 100 * high),
      c.passed() && c.done == c.planned};
  for (const std::string& failure : c.failures) line.result += "; " + failure;
  return line;
}

}  // namespace

std::vector<SelfCheckLine> SelfCheck(int threads, const std::function<void()>& advance, const std::atomic<bool>& stop) {
  std::vector<SelfCheckLine> lines;
  const auto run = [&](const ExperimentRequest& request, std::size_t count, Experiment* experiment) {
    *experiment = MakeExperiment(request);
    return RunTrials(*experiment, count, threads, advance, stop);
  };
  Experiment experiment;
  ExperimentRequest request = Base();
  request.range = MaterialRange{};
  request.range->alpha_low = 0.08;
  std::vector<Trial> trials = run(request, 30, &experiment);
  const Recovery recovery = JudgeRecovery(experiment, trials);
  lines.push_back({"random materials without noise are recovered",
                   fmt::format("{} fits; largest relative difference {:.1e}, {} beyond {:g}", recovery.trials,
                               recovery.largest, recovery.exceptions.size(), recovery.limit),
                   recovery.exceptions.empty() && recovery.trials == 30});

  request = Base();
  request.noise = ParseNoise("multiplicative=0.05");
  trials = run(request, 150, &experiment);
  const Calibration independent = Calibrate(experiment, trials);
  lines.push_back(LineOf("intervals under 5 % noise", independent));

  request.noise = ParseNoise("multiplicative=0.05,drift=0.03");
  trials = run(request, 100, &experiment);
  lines.push_back(LineOf("clustered intervals under 3 % drift", Calibrate(experiment, trials)));

  request = Base();
  request.noise = ParseNoise("multiplicative=0.05");
  request.truth.model.lobes[0].ndf = Ndf::kBeckmannOffCenter;
  trials = run(request, 30, &experiment);
  const Calibration wrong = Calibrate(experiment, trials);
  const bool quiet = independent.misfit.value <= 0.05, loud = wrong.misfit.count == 30;
  lines.push_back(
      {"a wrong model raises the misfit flag",
       fmt::format("Beckmann fitted with GGX: {} of {} flagged; the right model: {} of {}", wrong.misfit.count,
                   wrong.misfit.total, independent.misfit.count, independent.misfit.total),
       quiet && loud});
  return lines;
}

}  // namespace lobefit
