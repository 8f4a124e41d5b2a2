#include "options/synthesis_options.h"

#include "options/number_option.h"
#include "options/recipe_options.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/material/json.h"

namespace lobefit {
namespace {

std::vector<double> AngleList(const std::string& text, const char* option, double low, double below) {
  std::vector<double> angles;
  for (const std::string_view field : Split(text, ',')) {
    const std::optional<double> degrees = ParseDouble(field);
    if (!degrees)
      throw UsageError(fmt::format("{} '{}': '{}' is not a number; write degrees with commas between", option, text,
                                   Excerpt(field)));
    if (!(*degrees >= low && *degrees < below)) {
      throw UsageError(
          fmt::format("{} '{}': {} is not in [{}, {}) degrees", option, Excerpt(text), Excerpt(field), low, below));
    }
    angles.push_back(DegreesToRadians(*degrees));
  }
  return angles;
}

}  // namespace

void SynthesisOptions::AddTo(CLI::App* app) {
  std::vector<std::string> layouts, terms;
  for (const LayoutChoice& choice : LayoutChoices()) layouts.emplace_back(choice.name);
  for (const NoiseTerm& term : NoiseTerms()) terms.push_back(std::string(term.name) + " (" + term.description + ")");
  const std::string where = "Directions", what = "Instrument";
  app->add_option("--layout", layout_, "which directions are measured: " + Join(layouts) + ", or a measurement file")
      ->group(where);
  app->add_option("--theta-i", theta_i_, "polar angles of the light, degrees, with commas between")->group(where);
  app->add_option("--phi-i", phi_i_, "azimuths of the light, degrees, with commas between")->group(where);
  app->add_option("--detector-step", step_,
                  "step of the detector grid, degrees (half of it about the mirror direction)")
      ->check(Within(0.2, 45))
      ->group(where);
  app->add_option("--theta-max", theta_max_, "largest polar angle of the detector, degrees")
      ->check(Within(1, 89.9))
      ->group(where);
  app->add_flag("--in-plane", in_plane_, "the same as --layout in-plane")->group(where);
  app->add_option("--samples", samples_, "samples a light direction of the layouts by visible normals (default 256)")
      ->check(CLI::Range(4, 1000000))
      ->group(where);
  app->add_option(
         "--noise", noise_,
         "terms with commas between, as in multiplicative=0.05,drift=0.03; a number alone is multiplicative: " +
             Join(terms, ", "))
      ->group(what);
  app->add_option("--mean", mean_,
                  "what the discs of source and detector (--noise aperture=2,source=1) average: flux, f_r cos_theta_i "
                  "cos_theta_o over the means of the cosines (default), or plain, f_r")
      ->check(CLI::IsMember({"flux", "plain"}))
      ->group(what);
  app->add_option("--channels", channels_, "names of the channels of a recipe, with commas between")->group(what);
  app->add_option("--seed", seed_, "seed of the noise (default 1)")->group(what);
}

Truth SynthesisOptions::LoadTruth(const std::string& source) const {
  if (source.ends_with(".json")) return TruthOf(ReadModelMaterial(source));
  std::vector<std::string> channels;
  for (const std::string_view name : Split(channels_, ',')) channels.emplace_back(Trim(name));
  return TruthOf(LoadRecipe(source), channels, source);
}

LayoutRequest SynthesisOptions::Layout() const {
  LayoutRequest request;
  request.name = in_plane_ ? "in-plane" : layout_;
  request.samples = samples_;
  request.goniometer.polar_angles = AngleList(theta_i_, "--theta-i", 0, 90);
  request.goniometer.azimuths = AngleList(phi_i_, "--phi-i", -360, 360.001);
  request.goniometer.detector_step = DegreesToRadians(step_);
  request.goniometer.theta_max = DegreesToRadians(theta_max_);
  return request;
}

Noise SynthesisOptions::ChosenNoise() const {
  Noise noise = ParseNoise(ParseDouble(noise_) ? "multiplicative=" + noise_ : noise_);
  if (!mean_.empty()) noise.plain_mean = mean_ == "plain";
  return noise;
}

}  // namespace lobefit
