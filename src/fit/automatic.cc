#include "lobefit/fit/automatic.h"

#include <cmath>
#include <string>

#include "lobefit/base/error.h"
#include "lobefit/fit/fit.h"

namespace lobefit {
namespace {

std::size_t FreeParameters(const Recipe& recipe, std::size_t channels) {
  const std::vector<Parameter> parameters = Parameters(recipe.model);
  std::size_t count = 0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!recipe.IsFree(i)) continue;
    const bool shared = i < recipe.parameters.size() && recipe.parameters[i].shared;
    count += parameters[i].per_channel && !shared ? channels : 1;
  }
  return count;
}

std::size_t UsableSamples(const Samples& samples, double theta_max) {
  std::size_t count = 0;
  const double cos_max = std::cos(theta_max);
  for (std::size_t i = 0; i < samples.size(); ++i)
    count += samples.wi_z[i] >= cos_max && samples.wo_z[i] >= cos_max ? 1 : 0;
  return count;
}

}  // namespace

Recipe ChooseAutomatically(const Measurement& measurement) {
  Recipe automatic = AutomaticRecipe(TraitsOf(measurement));
  const std::size_t channels = measurement.channels.size();
  const std::size_t usable = UsableSamples(measurement.samples, automatic.theta_max), numbers = usable * channels;
  // With as many parameters as numbers it would go through all of them, and determine nothing beside.
  if (numbers > FreeParameters(automatic, channels)) return automatic;
  Model model;
  model.lobes.resize(1);
  model.lobes[0].ndf = Ndf::kGgx;
  Recipe simple = DefaultRecipe(model, "ggx");
  simple.plane_azimuth = automatic.plane_azimuth;
  const std::string few = std::to_string(usable) + (usable == 1 ? " usable sample is" : " usable samples are") +
                          " too few for the " + std::to_string(FreeParameters(automatic, channels)) +
                          " free parameters of '" + automatic.name + "'";
  simple.reason = few + ": one round lobe and a diffuse part";
  if (numbers >= FreeParameters(simple, channels)) return simple;
  model.diffuse = Diffuse::kNone;
  simple = DefaultRecipe(model, "ggx-without-diffuse");
  simple.plane_azimuth = automatic.plane_azimuth;
  simple.reason = few + ": one round lobe without a diffuse part";
  const std::size_t needed = FreeParameters(simple, channels);
  if (numbers >= needed) return simple;
  const std::size_t samples = (needed + channels - 1) / channels;
  throw InputError(measurement.source + ": " + few + ", and for any other; measure at least " +
                   std::to_string(samples) + " pairs of directions within " +
                   std::to_string(static_cast<int>(std::lround(simple.theta_max * 180 / 3.14159265358979323846))) +
                   " degrees of the normal");
}

}  // namespace lobefit
