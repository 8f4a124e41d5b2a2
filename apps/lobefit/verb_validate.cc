// lobefit validate: measurements from known parameters, fitted, and compared with what they were made from.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "output.h"
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
#include "lobefit/validate/pictures/picture.h"
#include "lobefit/validate/recovery.h"
#include "lobefit/validate/self_check.h"
#include "lobefit/validate/sweep.h"
#include "lobefit/validate/truth_file.h"

namespace lobefit {
namespace {

struct ValidateVerb {
  SynthesisOptions synthesis;
  FittedModel recipe;
  std::string source;
  std::size_t trials = 200;
  std::size_t starts = 8;
  bool draw = false, self_check = false;
  std::string sweep, picture;
};

// Set by the first SIGINT: trials that run are finished and reported. The second one ends the program.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void OnInterrupt(int signal) {
  interrupted = true;
  RemoveTemporariesOnSignal(signal);
}

ExperimentRequest RequestOf(const ValidateVerb& verb) {
  ExperimentRequest request;
  request.truth = verb.synthesis.LoadTruth(verb.source);
  request.noise = verb.synthesis.ChosenNoise();
  request.layout = verb.synthesis.Layout();
  request.seed = verb.synthesis.seed();
  request.recipe = verb.recipe.Choose(request.truth.model);
  if (request.noise.plain_mean) request.recipe.instrument.mean = ApertureMean::kPlain;
  request.fit.starts = verb.starts;
  if (verb.draw) request.range = MaterialRange{};
  return request;
}

std::vector<Trial> RunWithProgress(const Experiment& experiment, std::size_t count, int threads, Progress* progress) {
  return RunTrials(
      experiment, count, threads, [&] { progress->Advance(); }, interrupted);
}

// JSON as it is, text as a terminal may show it.
template <class Json, class Text>
void PrintResult(bool json, const Json& to_json, const Text& to_text) {
  if (json) {
    fmt::print("{}", to_json());
  } else {
    Print(to_text());
  }
}

int RunSweep(const ValidateVerb& verb, const CommonOptions& common) {
  Sweep sweep = ParseSweep(verb.sweep, RequestOf(verb));
  std::vector<Experiment> experiments;
  for (const SweepPoint& point : sweep.points) experiments.push_back(MakeExperiment(point.request));
  std::signal(SIGINT, OnInterrupt);
  {
    Progress progress("validate", verb.trials * sweep.points.size());
    for (std::size_t i = 0; i < sweep.points.size(); ++i) {
      sweep.points[i].trials = RunWithProgress(experiments[i], verb.trials, common.Threads(), &progress);
      sweep.points[i].calibration = Calibrate(experiments[i], sweep.points[i].trials);
    }
  }
  if (!verb.picture.empty()) DrawSweep(sweep, verb.picture);
  if (common.json) {
    std::string text;
    for (std::size_t i = 0; i < sweep.points.size(); ++i)
      text +=
          ToJsonLine(sweep.name, sweep.points[i].value, experiments[i], sweep.points[i].calibration, common.command);
    fmt::print("{}", text);
  } else {
    Print(ToText(sweep));
  }
  if (interrupted) std::fprintf(stderr, "lobefit: interrupted; points without trials show none\n");
  return kExitDone;
}

int RunSelfCheck(const CommonOptions& common) {
  std::signal(SIGINT, OnInterrupt);
  std::vector<SelfCheckLine> lines;
  {
    Progress progress("self-check", kSelfCheckTrials);
    lines = SelfCheck(
        common.Threads(), [&] { progress.Advance(); }, interrupted);
  }
  bool passed = true;
  for (const SelfCheckLine& line : lines) {
    fmt::print("{}  {}: {}\n", line.passed ? "pass" : "FAIL", line.what, line.result);
    passed = passed && line.passed;
  }
  fmt::print("{}\n", passed ? "PASSED" : "FAILED");
  return passed ? kExitDone : kExitFit;
}

int Report(const Experiment& experiment, const std::vector<Trial>& trials, const CommonOptions& common) {
  const Calibration calibration = Calibrate(experiment, trials);
  PrintResult(
      common.json, [&] { return ToJson(experiment, calibration, common.command); },
      [&] { return ToText(calibration); });
  if (interrupted) {
    std::fprintf(stderr, "lobefit: interrupted after %zu of %zu trials\n", calibration.done, calibration.planned);
  }
  return calibration.passed() ? kExitDone : kExitFit;
}

int RunTrialsOf(const ValidateVerb& verb, const CommonOptions& common) {
  const Experiment experiment = MakeExperiment(RequestOf(verb));
  std::signal(SIGINT, OnInterrupt);
  std::vector<Trial> trials;
  {
    Progress progress("validate", verb.trials);
    trials = RunWithProgress(experiment, verb.trials, common.Threads(), &progress);
  }
  if (experiment.noise == Noise{} && IsSameModel(experiment.recipe.model, experiment.truth.model)) {
    const Recovery recovery = JudgeRecovery(experiment, trials);
    if (!verb.picture.empty()) DrawRecovery(experiment, trials, recovery, verb.picture);
    PrintResult(
        common.json, [&] { return ToJson(experiment, recovery, common.command); },
        [&] { return ToText(recovery, experiment, trials); });
    return recovery.passed() ? kExitDone : kExitFit;
  }
  if (!verb.picture.empty()) DrawCalibration(experiment, trials, Calibrate(experiment, trials), verb.picture);
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
  Print(fmt::format("{}: made with noise {}, seed {}\n", PrintableName(verb.source), ToText(record->noise),
                    record->seed));
  Print(TrialToText(experiment, trial));
  const Calibration calibration = Calibrate(experiment, {trial});
  for (const std::string& failure : calibration.failures) Print(fmt::format("FAILED: {}\n", failure));
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
                  "of `lobefit synth`");
  app->add_option("--trials", verb->trials, "measurements to make and fit (default 200)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}));
  app->add_option("--starts", verb->starts, "descents of each fit from the best-ranked starts (default 8)")
      ->check(CLI::Range(1, 100000));
  app->add_option(
      "--sweep", verb->sweep,
      "NAME=VALUE,VALUE,...: the same at each value of a parameter of the truth, a noise term, alpha, ratio, "
      "tilt, incidences, azimuths, detector-step, metric or masking");
  app->add_option("--picture", verb->picture, "draw the result as a PNG file");
  app->add_flag("--self-check", verb->self_check, "a validation of this installation, without a source");
  app->add_flag("--draw", verb->draw, "every trial draws a material of the source's kind");
  verb->recipe.AddTo(app);
  verb->synthesis.AddTo(app);
  return [=] {
    if (verb->self_check) return RunSelfCheck(*common);
    if (verb->source.empty())
      throw UsageError("validate needs a SOURCE or --self-check; see `lobefit validate --help`");
    if (!verb->picture.empty()) CheckPicture(verb->picture, {verb->source});
    if (IsMeasurementFile(verb->source)) return RunFile(*verb, *common);
    return verb->sweep.empty() ? RunTrialsOf(*verb, *common) : RunSweep(*verb, *common);
  };
}

}  // namespace lobefit
