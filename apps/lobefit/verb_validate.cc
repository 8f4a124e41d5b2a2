// lobefit validate: measurements from known parameters, fitted, and compared with what they were made from.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "recipe_options.h"
#include "synthesis_options.h"
#include "verb.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/progress.h"
#include "lobefit/base/text.h"
#include "lobefit/io/read.h"
#include "lobefit/validate/calibration.h"
#include "lobefit/validate/calibration_json.h"
#include "lobefit/validate/truth_file.h"

namespace lobefit {
namespace {

struct ValidateVerb {
  SynthesisOptions synthesis;
  FittedModel recipe;
  std::string source;
  std::size_t trials = 200;
  std::size_t starts = 8;
  bool draw = false;
};

// Set by the first SIGINT: trials that run are finished and reported. The second one ends the program.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void OnInterrupt(int signal) {
  interrupted = true;
  std::signal(signal, SIG_DFL);
}

Experiment SetUpExperiment(const ValidateVerb& verb) {
  Experiment experiment;
  experiment.truth = verb.synthesis.LoadTruth(verb.source);
  experiment.noise = verb.synthesis.ChosenNoise();
  const MeasurementLayout layout = verb.synthesis.Layout(experiment.truth);
  experiment.directions = layout.directions;
  experiment.isotropic = layout.isotropic;
  experiment.seed = verb.synthesis.seed();
  experiment.recipe = verb.recipe.Choose(experiment.truth.model);
  experiment.fit.starts = verb.starts;
  if (verb.draw) experiment.range = MaterialRange{};
  return experiment;
}

int Report(const Experiment& experiment, const std::vector<Trial>& trials, const CommonOptions& common) {
  const Calibration calibration = Calibrate(experiment, trials);
  fmt::print("{}", common.json ? ToJson(experiment, calibration, common.command) : ToText(calibration));
  if (interrupted) {
    std::fprintf(stderr, "lobefit: interrupted after %zu of %zu trials\n", calibration.done, calibration.planned);
  }
  return calibration.passed() ? kExitDone : kExitFit;
}

int RunTrialsOf(const ValidateVerb& verb, const CommonOptions& common) {
  const Experiment experiment = SetUpExperiment(verb);
  std::signal(SIGINT, OnInterrupt);
  std::vector<Trial> trials;
  {
    Progress progress("validate", verb.trials);
    trials = RunTrials(
        experiment, verb.trials, common.Threads(), [&] { progress.Advance(); }, interrupted);
  }
  return Report(experiment, trials, common);
}

// A measurement file that carries its truth.
int RunFile(const ValidateVerb& verb, const CommonOptions& common) {
  const std::optional<TruthRecord> record = FindTruth(verb.source);
  if (!record) {
    throw InputError(fmt::format(
        "{}: carries no truth, neither in its comments nor in {}.truth.json; files made by `lobefit synth` do",
        verb.source, verb.source));
  }
  Measurement measurement = ReadMeasurement(verb.source, {});
  if (measurement.channels.names != record->truth.channels) {
    throw InputError(fmt::format("{}: its channels {} are not those of its truth, {}", verb.source,
                                 Join(measurement.channels.names), Join(record->truth.channels)));
  }
  Experiment experiment;
  experiment.truth = record->truth;
  experiment.noise = record->noise;
  experiment.seed = record->seed;
  experiment.recipe = verb.recipe.Choose(record->truth.model);
  experiment.fit.starts = verb.starts;
  experiment.fit.threads = common.Threads();
  const Trial trial = CompareWithTruth(experiment, record->truth, std::move(measurement));
  if (!trial.error.empty()) throw InputError(trial.error);
  if (common.json) return Report(experiment, {trial}, common);
  fmt::print("{}: made with noise {}, seed {}\n", verb.source, ToText(record->noise), record->seed);
  fmt::print("{}", TrialToText(experiment, trial));
  const Calibration calibration = Calibrate(experiment, {trial});
  for (const std::string& failure : calibration.failures) fmt::print("FAILED: {}\n", failure);
  return calibration.passed() ? kExitDone : kExitFit;
}

bool IsMeasurementFile(const std::string& source) {
  std::error_code error;
  return !source.ends_with(".json") && !source.ends_with(".toml") && std::filesystem::is_regular_file(source, error);
}

}  // namespace

std::function<int()> SetUpValidate(CLI::App* app, CommonOptions* common) {
  auto verb = std::make_shared<ValidateVerb>();
  app->add_option("SOURCE", verb->source,
                  "a *.material.json, a recipe (.toml or name) whose parameters have starts or fixed values, or a file "
                  "of `lobefit synth`")
      ->required();
  app->add_option("--trials", verb->trials, "measurements to make and fit (default 200)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}));
  app->add_option("--starts", verb->starts, "descents of each fit from the best-ranked starts (default 8)")
      ->check(CLI::Range(1, 100000));
  app->add_flag("--draw", verb->draw, "every trial draws a material of the source's kind");
  verb->recipe.AddTo(app);
  verb->synthesis.AddTo(app);
  return [=] { return IsMeasurementFile(verb->source) ? RunFile(*verb, *common) : RunTrialsOf(*verb, *common); };
}

}  // namespace lobefit
