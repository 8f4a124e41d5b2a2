#include "lobefit/recipe/recipe.h"

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/core/fresnel/optical_constants.h"

namespace lobefit {

const std::vector<Choice<Weighting>>& WeightingChoices() {
  static const std::vector<Choice<Weighting>> choices = {
      {Weighting::kCells, "cells", "every sample counts the same"},
      {Weighting::kSolidAngle, "solid-angle", "a sample counts by the solid angle of its cell"},
      {Weighting::kAuto, "auto", "solid-angle where the format knows its cells, else cells"},
  };
  return choices;
}

const std::vector<Choice<EnergyChoice>>& EnergyChoices() {
  static const std::vector<Choice<EnergyChoice>> choices = {
      {EnergyChoice::kFree, "free", "a lobe's reflectance is at most 1, the sum of all may be more"},
      {EnergyChoice::kConserving, "conserving", "the albedo is at most 1 at the measured incident directions"},
  };
  return choices;
}

const std::vector<Choice<ApertureMean>>& ApertureMeanChoices() {
  static const std::vector<Choice<ApertureMean>> choices = {
      {ApertureMean::kFlux, "flux", "mean of f_r cos_theta_i cos_theta_o over the means of the cosines"},
      {ApertureMean::kPlain, "plain", "mean of f_r"},
  };
  return choices;
}

std::uint16_t AlignmentRecipe::TurnOf(double azimuth) const {
  const auto distance = [&](double other) { return std::fabs(std::remainder(azimuth - other, 2 * kPi)); };
  const auto nearest =
      std::min_element(azimuths.begin(), azimuths.end(), [&](double a, double b) { return distance(a) < distance(b); });
  return static_cast<std::uint16_t>(nearest - azimuths.begin());
}

Aperture Recipe::aperture() const {
  return {instrument.source.value_or(0), instrument.detector.value_or(0), instrument.mean.value_or(ApertureMean::kFlux),
          instrument.detector_across.value_or(0)};
}

Aperture Recipe::widest_aperture() const {
  const auto widest = [](double half_angle, const std::optional<double>& prior) {
    return prior ? std::min(half_angle + kMostHalfAngleSigmas * *prior, kLargestHalfAngle) : half_angle;
  };
  Aperture discs = aperture();
  discs.source = widest(discs.source, instrument.source_prior);
  discs.detector = widest(discs.detector, instrument.detector_prior);
  return discs;
}

bool Recipe::IsFree(std::size_t index) const {
  return (Parameters(model)[index].free || parameters[index].free) && parameters[index].fixed.empty();
}

Recipe DefaultRecipe(const Model& model, const std::string& name) {
  Recipe recipe;
  recipe.name = name;
  recipe.model = model;
  for (const Parameter& parameter : Parameters(model)) {
    recipe.parameters.emplace_back();
    recipe.parameters.back().shared = parameter.shared;
  }
  return recipe;
}

Recipe WithMetals(const Recipe& recipe, const std::vector<double>& wavelengths_nm, std::size_t channels) {
  Recipe resolved = recipe;
  const std::vector<double>& wavelengths = recipe.wavelengths_nm.empty() ? wavelengths_nm : recipe.wavelengths_nm;
  for (std::size_t l = 0; l < recipe.model.lobes.size(); ++l) {
    const std::string& metal = recipe.model.lobes[l].metal;
    if (metal.empty()) continue;
    if (wavelengths.size() != channels) {
      throw InputError(
          fmt::format("recipe '{}': metal = '{}' needs one wavelength a channel, {} are known of {} channels; write "
                      "wavelengths_nm = "
                      "[...] into the recipe, or leave `metal` out and let eta and k be fitted",
                      recipe.name, metal, wavelengths.size(), channels));
    }
    const std::size_t first = FirstFresnel(recipe.model, l);
    ParameterRecipe& eta = resolved.parameters[first];
    ParameterRecipe& k = resolved.parameters[first + 1];
    eta.fixed.clear();
    k.fixed.clear();
    for (const double wavelength : wavelengths) {
      const ConductorIndex index = MetalIndexAt(metal, wavelength).index;
      eta.fixed.push_back(index.eta);
      k.fixed.push_back(index.k);
    }
  }
  return resolved;
}

Recipe AutomaticRecipe(const MeasurementTraits& traits) {
  Model model;
  model.lobes.resize(1);
  std::string name, reason;
  if (traits.isotropic) {
    model.lobes[0].ndf = Ndf::kGgx;
    name = "ggx";
    reason = "the format is isotropic by construction, so one alpha and no rotation can be determined";
  } else if (traits.in_plane) {
    model.lobes[0].ndf = Ndf::kGgxTilted;
    name = "ggx-tilted";
    reason =
        "all samples lie in one plane, so nothing that lives out of it can be determined: one alpha, and a tilt within "
        "the plane";
  } else {
    model.lobes[0].ndf = Ndf::kEllipsoid;
    name = "ellipsoid";
    reason = "the samples leave the plane of incidence, so all five parameters of the ellipsoid can be determined";
  }
  Recipe recipe = DefaultRecipe(model, name);
  recipe.reason = reason;
  recipe.plane_azimuth = traits.plane_azimuth;
  return recipe;
}

}  // namespace lobefit
