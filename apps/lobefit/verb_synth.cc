// lobefit synth: a measurement file from a known model, with declared noise.
#include <filesystem>
#include <memory>

#include "recipe_options.h"
#include "verb.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text.h"
#include "lobefit/core/reflectance.h"
#include "lobefit/io/write_csv.h"
#include "lobefit/material/json.h"
#include "lobefit/math/vec.h"
#include "lobefit/measurement/synthesis.h"

namespace lobefit {
namespace {

struct SynthVerb {
  std::string source, out, channels = "R,G,B", theta_i = "5,15,25,30,35,40,45,50,55,60,65,70", phi_i = "0";
  double step = 10, theta_max = 80, noise = 0, noise_floor = 0;
  bool in_plane = false;
  int digits = 17;
  std::uint64_t seed = 1;
};

std::vector<double> AngleList(const std::string& text, const char* option) {
  std::vector<double> angles;
  for (const std::string_view field : Split(text, ',')) {
    const std::optional<double> degrees = ParseDouble(field);
    if (!degrees)
      throw UsageError(fmt::format("{} '{}': '{}' is not a number; write degrees with commas between", option, text,
                                   Excerpt(field)));
    angles.push_back(DegreesToRadians(*degrees));
  }
  return angles;
}

// The truth: a material document, or a recipe whose parameters all have a start or a fixed value.
struct Truth {
  Model model;
  ParameterValues values;
  std::vector<std::string> channels;
};

Truth LoadTruth(const SynthVerb& verb) {
  if (verb.source.ends_with(".json")) {
    const Material material = ReadMaterial(verb.source);
    return {material.model, material.Values(), material.channels};
  }
  const Recipe recipe = LoadRecipe(verb.source);
  Truth truth = {recipe.model, {}, {}};
  for (const std::string_view name : Split(verb.channels, ',')) truth.channels.emplace_back(Trim(name));
  const std::vector<Parameter> parameters = Parameters(recipe.model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterRecipe& entry = recipe.parameters[i];
    std::vector<double> values = entry.fixed.empty() ? entry.start : entry.fixed;
    const bool tied = values.empty() && !parameters[i].free;
    if (tied) values = {parameters[i].unit == "deg" ? 0.0 : truth.values[i - 1][0]};
    const std::size_t wanted = parameters[i].per_channel ? truth.channels.size() : 1;
    if (values.size() == 1) values.resize(wanted, values[0]);
    if (values.size() != wanted) {
      throw InputError(fmt::format(
          "{}: parameter '{}' has {} values, {} are needed for channels {}; give it a start or a fixed value",
          verb.source, parameters[i].json_name, values.size(), wanted, verb.channels));
    }
    truth.values.push_back(values);
  }
  return truth;
}

int RunSynth(const SynthVerb& verb, const CommonOptions& common) {
  const Truth truth = LoadTruth(verb);
  const Reflectance reflectance(truth.model, truth.values, truth.channels.size());
  GoniometerLayout layout;
  layout.polar_angles = AngleList(verb.theta_i, "--theta-i");
  layout.azimuths = AngleList(verb.phi_i, "--phi-i");
  layout.detector_step = DegreesToRadians(verb.step);
  layout.theta_max = DegreesToRadians(verb.theta_max);
  layout.in_plane = verb.in_plane;
  const Measurement measurement = Synthesise(
      Goniometer(layout), {truth.channels, {}},
      [&](const Vec3& wi, const Vec3& wo, double* values) { reflectance.Evaluate(wi, wo, values); },
      {verb.noise, verb.noise_floor}, verb.seed);
  std::vector<std::string> comments = {"synthetic measurement, made by: " + common.command};
  const std::vector<Parameter> parameters = Parameters(truth.model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    std::vector<std::string> numbers;
    for (const double value : truth.values[i]) numbers.push_back(FormatDouble(value / InsideFactor(parameters[i])));
    comments.push_back("lobefit.truth." + parameters[i].json_name + ": " + Join(numbers, " "));
  }
  comments.push_back(fmt::format("lobefit.noise.multiplicative: {}", FormatDouble(verb.noise)));
  comments.push_back(fmt::format("lobefit.noise.additive: {}", FormatDouble(verb.noise_floor)));
  comments.push_back(fmt::format("lobefit.seed: {}", verb.seed));
  WriteCsv(measurement, comments, verb.out, verb.digits);
  fmt::print("{}: {} samples, {} channels\n", verb.out, measurement.samples.size(), measurement.channels.size());
  return kExitDone;
}

}  // namespace

std::function<int()> SetUpSynth(CLI::App* app, CommonOptions* common) {
  auto verb = std::make_shared<SynthVerb>();
  app->add_option("SOURCE", verb->source,
                  "a *.material.json, or a recipe (.toml or name) whose parameters have starts or fixed values")
      ->required();
  app->add_option("--out", verb->out, "the file to write (.csv)")->required();
  app->add_option("--theta-i", verb->theta_i, "polar angles of the light, degrees, with commas between");
  app->add_option("--phi-i", verb->phi_i, "azimuths of the light, degrees, with commas between");
  app->add_option("--detector-step", verb->step,
                  "step of the detector grid, degrees (half of it about the mirror direction)")
      ->check(CLI::Range(0.2, 45.0));
  app->add_option("--theta-max", verb->theta_max, "largest polar angle of the detector, degrees")
      ->check(CLI::Range(1.0, 89.9));
  app->add_flag("--in-plane", verb->in_plane, "only detectors in the plane of incidence, at half the step");
  app->add_option("--noise", verb->noise, "relative standard deviation of multiplicative noise")
      ->check(CLI::Range(0.0, 10.0));
  app->add_option("--noise-additive", verb->noise_floor, "standard deviation of additive noise, 1/sr")
      ->check(CLI::Range(0.0, 1e6));
  app->add_option("--channels", verb->channels, "names of the channels of a recipe, with commas between");
  app->add_option("--digits", verb->digits, "significant digits of the numbers (default 17: nothing is lost)")
      ->check(CLI::Range(4, 17));
  app->add_option("--seed", verb->seed, "seed of the noise");
  return [=] { return RunSynth(*verb, *common); };
}

}  // namespace lobefit
