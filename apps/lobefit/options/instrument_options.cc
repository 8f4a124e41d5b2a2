#include "options/instrument_options.h"

#include "options/number_option.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/vec.h"
#include "lobefit/measurement/stated_instrument.h"

namespace lobefit {

ApertureMean ParseApertureMean(const std::string& text) {
  const Choice<ApertureMean>* choice = Find(ApertureMeanChoices(), text);
  if (choice == nullptr) {
    const std::vector<std::string> names = Names(ApertureMeanChoices());
    throw UsageError(
        fmt::format("--mean '{}' is unknown{}; allowed: {}", Excerpt(text), DidYouMean(text, names), Join(names)));
  }
  return choice->value;
}

void InstrumentOptions::AddTo(CLI::App* app, bool with_mean) {
  const std::string group = "Instrument";
  const CLI::Validator half_angles = Within(0, RadiansToDegrees(kLargestHalfAngle));
  app->add_option("--source", source_deg_,
                  "half angle, in degrees, of the disc that the source fills as seen from the sample; the fit averages "
                  "over it (default: as the recipe, else the file states it; 0: a point)")
      ->check(half_angles)
      ->group(group);
  app->add_option("--detector", detector_deg_, "the same for the detector")->check(half_angles)->group(group);
  app->add_option(
         "--detector-across", across_deg_,
         "the detector is a flat rectangle: its half angle across the meridian, --detector being that along it")
      ->check(Within(1e-4, RadiansToDegrees(kLargestHalfAngle)))
      ->group(group);
  app->add_option(
         "--source-prior", source_prior_deg_,
         "how well the half angle of --source, or the one that the file states, is known: a standard deviation "
         "in degrees; it is then fitted")
      ->check(Within(1e-4, RadiansToDegrees(kLargestHalfAngle)))
      ->group(group);
  app->add_option("--detector-prior", detector_prior_deg_, "the same for the detector")
      ->check(Within(1e-4, RadiansToDegrees(kLargestHalfAngle)))
      ->group(group);
  app->add_option("--drift", drift_,
                  "gains of the incident directions, solved for: auto estimates their standard deviation, a number "
                  "gives it (0.03: 3 %)")
      ->group(group);
  app->add_option("--alignment", alignment_deg_,
                  "the sample may stand crooked by so many degrees (a standard deviation), which is fitted beside the "
                  "lobe's tilt; FILE:turned=true names a second measurement with the sample turned by 180 degrees")
      ->check(Within(1e-3, kMostAlignmentDeg))
      ->group(group);
  app->add_flag("--offset", offset_, "readings may be too high by a constant of each channel")->group(group);
  app->add_option("--noise-model", noise_model_,
                  "noise of the readings f_r cos_theta_i for the metric asinh, as in floor=0.002,relative=0.03 or with "
                  "poisson=0.0001, the reading of one count; else it is estimated")
      ->group(group);
  if (!with_mean) return;
  app->add_option("--mean", mean_,
                  "what a value is the mean of: flux (f_r cos_theta_i cos_theta_o over the means of the cosines, "
                  "default), plain (f_r)")
      ->group(group);
}

void InstrumentOptions::Apply(Recipe* recipe) const {
  if (source_deg_ >= 0) recipe->instrument.source = DegreesToRadians(source_deg_);
  if (detector_deg_ >= 0) recipe->instrument.detector = DegreesToRadians(detector_deg_);
  if (across_deg_ > 0) recipe->instrument.detector_across = DegreesToRadians(across_deg_);
  if (source_prior_deg_ > 0) recipe->instrument.source_prior = DegreesToRadians(source_prior_deg_);
  if (detector_prior_deg_ > 0) recipe->instrument.detector_prior = DegreesToRadians(detector_prior_deg_);
  if (!mean_.empty()) recipe->instrument.mean = ParseApertureMean(mean_);
  if (!drift_.empty()) {
    const std::optional<StatedDrift> drift = ParseDrift(drift_);
    if (!drift) {
      throw UsageError(
          fmt::format("--drift '{}': allowed are auto and a relative standard deviation in (0, 1]", Excerpt(drift_)));
    }
    recipe->instrument.drift = DriftRecipe{drift->sd};
  }
  if (!noise_model_.empty()) {
    const std::optional<StatedNoise> noise = ParseNoiseModel(noise_model_);
    if (!noise) {
      throw UsageError(
          fmt::format("--noise-model '{}': allowed is as in floor=0.002,relative=0.03,poisson=0.0001, floor or poisson "
                      "above 0, relative in (0, 1]",
                      Excerpt(noise_model_)));
    }
    recipe->noise = {noise->floor, noise->relative, noise->poisson};
  }
  if (alignment_deg_ > 0) {
    recipe->instrument.alignment = AlignmentRecipe();
    recipe->instrument.alignment->prior = DegreesToRadians(alignment_deg_);
  }
  recipe->instrument.offset = recipe->instrument.offset || offset_;
  if (recipe->sel && (source_deg_ >= 0 || detector_deg_ >= 0 || source_prior_deg_ > 0 || detector_prior_deg_ > 0 ||
                      across_deg_ > 0 || !mean_.empty() || !noise_model_.empty() || recipe->instrument.drift ||
                      recipe->instrument.alignment || recipe->instrument.offset)) {
    throw UsageError("an instrument is fitted with a model; recipe '" + recipe->name +
                     "' is a table of lobes, which takes readings as they are");
  }
}

}  // namespace lobefit
