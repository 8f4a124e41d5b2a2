// lobefit validate: measurements from known parameters, fitted, and compared with what they were made from.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "options/recipe_options.h"
#include "options/synthesis_options.h"
#include "tasks/trial_parts.h"
#include "text/output.h"
#include "verbs/verb.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/process/progress.h"
#include "lobefit/base/text/text.h"
#include "lobefit/batch/results/results.h"
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

// Trials on the measurements of others, with an experiment of their own.
struct ComparedTrials {
  Experiment experiment;
  std::vector<Trial> trials;
};

struct ValidateVerb {
  SynthesisOptions synthesis;
  FittedModel recipe;
  std::string source;
  std::size_t trials = 200;
  std::size_t starts = 8;
  bool draw = false, self_check = false, without_instrument = false, turned = false;
  std::string sweep, picture;
  TrialParts parts;
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
  request.turned = verb.turned;
  request.seed = verb.synthesis.seed();
  request.recipe = verb.recipe.Choose(request.truth.model);
  if (request.noise.plain_mean) request.recipe.instrument.mean = ApertureMean::kPlain;
  request.fit.starts = verb.starts;
  if (verb.draw) request.range = MaterialRange{};
  return request;
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
      sweep.points[i].trials = RunTrials(
          experiments[i], verb.trials, common.Threads(), [&] { progress.Advance(); }, interrupted);
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

// The same fitted as if nothing were known of the instrument, whatever the measurement states.
Experiment WithoutInstrument(Experiment experiment) {
  InstrumentRecipe* instrument = &experiment.recipe.instrument;
  const bool any =
      experiment.recipe.aperture().any() || instrument->drift || instrument->alignment || instrument->offset;
  if (!any) {
    throw UsageError(
        "--without-instrument shows what a fit through the instrument gains: give --source, --detector, --drift, "
        "--alignment or --offset too");
  }
  *instrument = {};
  instrument->source = instrument->detector = 0;
  return experiment;
}

int Report(const Experiment& experiment, const std::vector<Trial>& trials, const std::optional<ComparedTrials>& without,
           const CommonOptions& common) {
  const Calibration calibration = Calibrate(experiment, trials);
  std::optional<Calibration> compared;
  if (without) compared = Calibrate(without->experiment, without->trials);
  PrintResult(
      common.json, [&] { return ToJson(experiment, calibration, compared ? &*compared : nullptr, common.command); },
      [&] {
        std::string text = ToText(calibration);
        if (compared)
          text += "\nThe same measurements, fitted without the instrument (not judged):\n" + TableOf(*compared);
        return text;
      });
  if (calibration.done < calibration.planned) {
    std::fprintf(stderr, "lobefit: %s%zu of %zu trials are done\n", interrupted ? "interrupted: " : "",
                 calibration.done, calibration.planned);
    return kExitMissing;
  }
  return calibration.passed() ? kExitDone : kExitFit;
}

int RunTrialsOf(const ValidateVerb& verb, const CommonOptions& common) {
  const Experiment experiment = MakeExperiment(RequestOf(verb));
  std::optional<ComparedTrials> without;
  if (verb.without_instrument) without = {WithoutInstrument(experiment), {}};
  if (verb.parts.is_script()) return verb.parts.WriteScript(verb.trials, common);
  std::signal(SIGINT, OnInterrupt);
  std::signal(SIGTERM, OnInterrupt);
  std::vector<Trial> trials;
  {
    Progress progress("validate", verb.parts.Count(verb.trials) * (without ? 2 : 1));
    trials = verb.parts.Run(experiment, verb.trials, "", common.Threads(), &progress, interrupted);
    if (without) {
      without->trials = verb.parts.Run(without->experiment, verb.trials, "without-instrument", common.Threads(),
                                       &progress, interrupted);
    }
  }
  if (verb.parts.is_part()) return interrupted ? kExitMissing : kExitDone;
  if (experiment.noise == Noise{} && IsSameModel(experiment.recipe.model, experiment.truth.model)) {
    const Recovery recovery = JudgeRecovery(experiment, trials);
    if (!verb.picture.empty()) DrawRecovery(experiment, trials, recovery, verb.picture);
    PrintResult(
        common.json, [&] { return ToJson(experiment, recovery, common.command); },
        [&] { return ToText(recovery, experiment, trials); });
    return recovery.passed() ? kExitDone : kExitFit;
  }
  if (!verb.picture.empty()) DrawCalibration(experiment, trials, Calibrate(experiment, trials), verb.picture);
  return Report(experiment, trials, without, common);
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
  if (common.json) return Report(experiment, {trial}, {}, common);
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
  app->add_flag("--without-instrument", verb->without_instrument,
                "fit each measurement also without the instrument that the fit is given, and show both");
  app->add_flag("--turned", verb->turned,
                "measure every sample a second time, turned by 180 degrees on its stage, and fit both files together");
  app->add_flag("--draw", verb->draw, "every trial draws a material of the source's kind");
  verb->recipe.AddTo(app);
  verb->synthesis.AddTo(app);
  verb->parts.AddTo(app);
  return [=] {
    if (verb->self_check) return RunSelfCheck(*common);
    if (verb->source.empty())
      throw UsageError("validate needs a SOURCE or --self-check; see `lobefit validate --help`");
    verb->parts.Check(!verb->sweep.empty() || IsMeasurementFile(verb->source));
    if (!verb->picture.empty()) CheckPicture(verb->picture, {verb->source});
    if (IsMeasurementFile(verb->source)) return RunFile(*verb, *common);
    return verb->sweep.empty() ? RunTrialsOf(*verb, *common) : RunSweep(*verb, *common);
  };
}

}  // namespace lobefit
