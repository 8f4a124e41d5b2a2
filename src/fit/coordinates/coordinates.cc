#include "lobefit/fit/coordinates/coordinates.h"

#include <algorithm>
#include <cmath>

#include "lobefit/base/error.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

constexpr const char* kSlopeNames[] = {"slope_x", "slope_y", "ln a", "b", "ln c"};
// Slopes of 10 are normals 84 degrees from the surface's; widths from 1e-4 (a mirror) to 10 (nearly uniform over the
// hemisphere).
constexpr double kSlopeLow[] = {-10, -10, -9.2103403719761836, -10, -9.2103403719761836};
constexpr double kSlopeHigh[] = {10, 10, 2.302585092994046, 10, 2.302585092994046};

// tau of the coefficients' prior. Without data a coefficient stays within it; 5 % noise and 40 samples determine those
// within the data to a tenth of it.
constexpr double kProfileSpread = 2;

}  // namespace

Layout::Layout(const Recipe& recipe, const std::vector<std::string>& channels)
    : recipe_(recipe), channels_(channels.size()), linear_(channels.size()) {
  const std::vector<Parameter> parameters = Parameters(recipe.model);
  for (std::size_t lobe = 0; lobe < recipe.model.lobes.size(); ++lobe) {
    AddShape(lobe, parameters, FirstParameter(recipe.model, lobe));
  }
  first_angle_ = coordinates_.size();
  if (recipe.instrument.alignment) AddAngles();
  first_half_angle_ = coordinates_.size();
  AddHalfAngles();
  shape_size_ = coordinates_.size();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].group != ParameterGroup::kShape) AddLinear(parameters[i], recipe.parameters[i], channels);
  }
  if (recipe.instrument.offset) AddOffset(channels);
  if (coordinates_.empty())
    throw InputError("recipe '" + recipe.name + "': every parameter is fixed; free at least one");
}

void Layout::AddShape(std::size_t lobe, const std::vector<Parameter>& parameters, std::size_t first_parameter) {
  Shape shape;
  shape.first = coordinates_.size();
  const Ndf ndf = recipe_.model.lobes[lobe].ndf;
  shape.tied = IsRound(ndf);
  if (IsInPlane(ndf)) shape.fixed[4] = -recipe_.plane_azimuth;
  bool restricted = shape.tied;
  for (std::size_t i = 0; i < 5; ++i) {
    const ParameterRecipe& entry = recipe_.parameters[first_parameter + i];
    if (!entry.fixed.empty()) shape.fixed[i] = entry.fixed[0];
    restricted = restricted || !entry.fixed.empty() || entry.low || entry.high;
  }
  const std::string prefix = lobe == 0 ? "" : "lobe" + std::to_string(lobe + 1) + ".";
  shape.slope = !restricted;
  if (shape.slope) {
    shape.entries = IsTilted(ndf) ? std::vector<int>{0, 1, 2, 3, 4} : std::vector<int>{2, 3, 4};
    for (const int i : shape.entries) coordinates_.push_back({prefix + kSlopeNames[i], kSlopeLow[i], kSlopeHigh[i]});
  } else {
    for (int i = 0; i < 5; ++i) {
      const Parameter& parameter = parameters[first_parameter + static_cast<std::size_t>(i)];
      const ParameterRecipe& entry = recipe_.parameters[first_parameter + static_cast<std::size_t>(i)];
      if (!parameter.free || !entry.fixed.empty()) continue;
      const double low = entry.low.value_or(parameter.low), high = entry.high.value_or(parameter.high);
      shape.entries.push_back(i);
      if (i < 2) {
        coordinates_.push_back({"ln " + parameter.name, std::log(low), std::log(high)});
      } else {
        coordinates_.push_back({parameter.name, low, high});
      }
    }
  }
  AddProfile(lobe, parameters, &shape);
  AddMean(lobe, &shape);
  shapes_.push_back(shape);
}

void Layout::AddProfile(std::size_t lobe, const std::vector<Parameter>& parameters, Shape* shape) {
  const std::size_t first = FirstParameter(recipe_.model, lobe) + kEllipseParameters;
  for (std::size_t k = 0; k + kEllipseParameters < ShapeParameters(recipe_.model.lobes[lobe]); ++k) {
    const Parameter& parameter = parameters[first + k];
    const ParameterRecipe& entry = recipe_.parameters[first + k];
    const double start = entry.start.empty() ? parameter.start : entry.start[0];
    shape->profile_start.push_back(entry.fixed.empty() ? start : entry.fixed[0]);
    if (!entry.fixed.empty()) continue;
    const double low = entry.low.value_or(parameter.low), high = entry.high.value_or(parameter.high);
    shape->profile.push_back(k);
    if (IsExponent(lobe)) {
      const double least = LeastExponent(lobe);
      coordinates_.push_back({least > 0 ? "ln(" + parameter.name + " - 3/2)" : "ln " + parameter.name,
                              std::log(low - least), std::log(high - least)});
    } else {
      coordinates_.push_back({parameter.name, low, high, 1 / (kProfileSpread * kProfileSpread)});
    }
  }
}

void Layout::AddMean(std::size_t lobe, Shape* shape) {
  const Aperture aperture = recipe_.widest_aperture();
  if (!aperture.any()) return;
  const Lobe& kind = recipe_.model.lobes[lobe];
  const double larger = std::max(aperture.source, aperture.detector),
               smaller = std::min(aperture.source, aperture.detector);
  double width = recipe_.instrument.finest_width > 0 ? recipe_.instrument.finest_width : smaller;
  if (!HasMeanInClosedForm(kind)) {
    width = larger / (2 * kMostRelativeWidth * kMeanCosine) * (1 + 1e-9);
    // Width coordinates: ln a and ln c, or ln alpha.
    for (std::size_t k = 0; k < shape->entries.size(); ++k) {
      const int i = shape->entries[k];
      if (shape->slope ? i != 2 && i != 4 : i >= 2) continue;
      Coordinate& coordinate = coordinates_[shape->first + k];
      coordinate.low = std::max(coordinate.low, std::log(width));
      if (coordinate.low < coordinate.high) continue;
      throw InputError("recipe '" + recipe_.name + "': the bounds of " + coordinate.name +
                       " allow no lobe that is wide enough for the aperture; allowed are widths above " +
                       std::to_string(width) + " with the distribution '" + NameOf(NdfChoices(), kind.ndf) +
                       "', any with GGX and Smith masking");
    }
  }
  shape->mean =
      std::make_shared<const LobeMeanRule>(MakeLobeMeanRule(kind, aperture, std::max(width, 1e-6), kMeanCosine));
}

void Layout::AddAngles() {
  const AlignmentRecipe& alignment = *recipe_.instrument.alignment;
  for (std::size_t k = 0; k < alignment.azimuths.size() + 1; ++k) {
    const double prior = k < 2 ? alignment.prior : alignment.prior_turn;
    const std::string name = k == 0 ? "e_x" : k == 1 ? "e_y" : "e_z[" + std::to_string(k) + "]";
    // Beyond them a prior of this width has no weight that matters.
    const double bound = std::min(20 * prior, kPi / 18);
    coordinates_.push_back({name, -bound, bound, 1 / (prior * prior), true});
  }
}

void Layout::AddHalfAngles() {
  const auto add = [this](const char* name, double half_angle, const std::optional<double>& prior) {
    if (!prior) return;
    // A disc of no width is a point, at which nothing tells its half angle.
    constexpr double kLeast = 0.1;
    const double low = -std::min(kMostHalfAngleSigmas * *prior, (1 - kLeast) * half_angle),
                 high = std::min(kMostHalfAngleSigmas * *prior, kLargestHalfAngle - half_angle);
    coordinates_.push_back({name, low, high, 1 / (*prior * *prior), true});
  };
  const Aperture aperture = recipe_.aperture();
  add("source", aperture.source, recipe_.instrument.source_prior);
  add("detector", aperture.detector, recipe_.instrument.detector_prior);
}

void Layout::AddOffset(const std::vector<std::string>& channels) {
  constexpr double kMostOffset = 1e6;
  for (std::size_t c = 0; c < channels_; ++c) {
    linear_[c].push_back({static_cast<int>(coordinates_.size()), 0, 0});
    coordinates_.push_back({"offset[" + channels[c] + "]", -kMostOffset, kMostOffset});
  }
}

void Layout::AddLinear(const Parameter& parameter, const ParameterRecipe& entry,
                       const std::vector<std::string>& channels) {
  const double low = entry.low.value_or(parameter.low), high = entry.high.value_or(parameter.high);
  for (std::size_t c = 0; c < channels_; ++c) {
    Linear linear;
    linear.start = entry.start.empty() ? parameter.start : entry.start[std::min(c, entry.start.size() - 1)];
    if (!parameter.free && !entry.free && entry.fixed.empty()) {
      linear.value = parameter.start;
    } else if (!entry.fixed.empty()) {
      if (entry.fixed.size() != 1 && entry.fixed.size() != channels_) {
        throw InputError("recipe '" + recipe_.name + "': '" + parameter.json_name + "' is fixed to " +
                         std::to_string(entry.fixed.size()) + " values, the measurement has " +
                         std::to_string(channels_) + " channels");
      }
      linear.value = entry.fixed[entry.fixed.size() == 1 ? 0 : c];
    } else if (entry.shared && c > 0) {
      linear.index = linear_[0].back().index;
    } else {
      linear.index = static_cast<int>(coordinates_.size());
      coordinates_.push_back({parameter.name + (entry.shared ? "" : "[" + channels[c] + "]"), low, high});
    }
    linear_[c].push_back(linear);
  }
}

}  // namespace lobefit
