#include "lobefit/recipe/toml_instrument.h"

#include <optional>

#include <fmt/format.h>

#include "lobefit/math/vec.h"
#include "lobefit/recipe/toml_values.h"

namespace lobefit {
namespace {

// An angle in degrees of { value, across, prior_deg }; above 0, as 0 is allowed for the value alone.
std::optional<double> DiscAngle(const toml::table& table, const char* key, const char* disc, const char* meaning,
                                const TomlFile& place) {
  const std::optional<double> degrees = OptionalNumber(table, key, place);
  if (!degrees) return std::nullopt;
  const double highest = RadiansToDegrees(kLargestHalfAngle);
  if (!(*degrees > 0 && *degrees <= highest + 1e-9)) {
    place.Fail(table.get(key)->source(),
               fmt::format("{} of {} is {:g}: {}, in degrees, must lie in (0, {:g}]; leave it "
                           "out where there is none",
                           key, disc, *degrees, meaning, highest));
  }
  return DegreesToRadians(*degrees);
}

// The half angle of a disc, in degrees: 1.5; { value = 1.5, prior_deg = 0.2 } where it is fitted, without a value about
// the one that the file states; { value = 1.5, across = 4 } for a rectangle. `across` null: a disc it is.
void ReadHalfAngle(const toml::table& instrument, const char* key, const TomlFile& place,
                   std::optional<double>* half_angle, std::optional<double>* prior, std::optional<double>* across) {
  const toml::node* node = instrument.get(key);
  if (node == nullptr) return;
  const toml::table* table = node->as_table();
  std::optional<double> degrees;
  if (table != nullptr) {
    std::vector<std::string> keys = {"value", "prior_deg"};
    if (across != nullptr) keys.emplace_back("across");
    place.CheckKeys(*table, keys, std::string("of ") + key);
    degrees = OptionalNumber(*table, "value", place);
    *prior = DiscAngle(*table, "prior_deg", key, "the standard deviation with which the half angle is known", place);
    if (across != nullptr)
      *across = DiscAngle(*table, "across", key, "the half angle of a rectangle across the meridian", place);
    const bool shaped = *prior || (across != nullptr && *across);
    if (degrees && *degrees == 0 && shaped) {
      place.Fail(node->source(),
                 fmt::format("{} is a point (value = 0), which is neither fitted nor a rectangle; give a "
                             "half angle above 0, or leave the rest out",
                             key));
    }
    if (*prior && across != nullptr && *across) {
      place.Fail(node->source(), fmt::format("{} is a rectangle, whose half angles are not fitted; leave prior_deg or "
                                             "across out",
                                             key));
    }
    if (!degrees) return;
  } else {
    degrees = OptionalNumber(instrument, key, place);
  }
  const double highest = RadiansToDegrees(kLargestHalfAngle);
  if (!(*degrees >= 0 && *degrees <= highest + 1e-9)) {
    place.Fail(node->source(), fmt::format("{} = {:g}: the half angle of a disc, in degrees, must lie in [0, {:g}]",
                                           key, *degrees, highest));
  }
  *half_angle = DegreesToRadians(*degrees);
}

}  // namespace

void ReadInstrument(const toml::table& root, const TomlFile& place, Recipe* recipe) {
  const toml::table* table = TableOf(root, "instrument", place);
  if (table == nullptr) return;
  place.CheckKeys(*table, {"source", "detector", "mean", "noise", "drift", "alignment", "offset"}, "of [instrument]");
  InstrumentRecipe* instrument = &recipe->instrument;
  ReadHalfAngle(*table, "source", place, &instrument->source, &instrument->source_prior, nullptr);
  ReadHalfAngle(*table, "detector", place, &instrument->detector, &instrument->detector_prior,
                &instrument->detector_across);
  if (table->contains("mean")) {
    recipe->instrument.mean = ApertureMean::kFlux;
    ReadChoice(*table, "mean", ApertureMeanChoices(), place, &*recipe->instrument.mean);
  }
  if (const toml::table* noise = TableOf(*table, "noise", place)) {
    place.CheckKeys(*noise, {"floor", "relative", "poisson"}, "of the noise");
    const double floor = OptionalNumber(*noise, "floor", place).value_or(0),
                 poisson = OptionalNumber(*noise, "poisson", place).value_or(0),
                 relative = OptionalNumber(*noise, "relative", place).value_or(0);
    const bool dark = floor >= 0 && poisson >= 0 && (floor > 0 || poisson > 0);
    if (!dark || !(relative > 0 && relative <= 1)) {
      place.Fail(
          noise->source(),
          "noise is written as { floor = 0.002, relative = 0.03, poisson = 0.0001 }: of f_r cos(theta_i) the floor "
          "and the value of one count, in 1/sr, one of them above 0, and the relative part in (0, 1]");
    }
    recipe->noise = {floor, relative, poisson};
  }
  if (const toml::node* drift = table->get("drift")) {
    const std::optional<double> sd = drift->value<double>();
    if (!(drift->is_string() && *drift->value<std::string>() == "auto") && !(sd && *sd > 0 && *sd <= 1))
      place.Fail(drift->source(), "drift is \"auto\" or the relative standard deviation of a gain, in (0, 1]");
    recipe->instrument.drift = drift->is_string() ? DriftRecipe{} : DriftRecipe{*sd};
  }
  if (const toml::table* alignment = TableOf(*table, "alignment", place)) {
    place.CheckKeys(*alignment, {"prior_deg"}, "of the alignment");
    const double prior =
        OptionalNumber(*alignment, "prior_deg", place).value_or(RadiansToDegrees(AlignmentRecipe().prior));
    if (!(prior > 0 && prior <= kMostAlignmentDeg)) {
      place.Fail(alignment->source(),
                 fmt::format("prior_deg = {:g}: the standard deviation of a crooked sample's angles, in degrees, must "
                             "lie in (0, {:g}]",
                             prior, kMostAlignmentDeg));
    }
    recipe->instrument.alignment = AlignmentRecipe();
    recipe->instrument.alignment->prior = DegreesToRadians(prior);
  }
  if (const toml::node* offset = table->get("offset")) {
    if (!offset->is_boolean()) place.Fail(offset->source(), "'offset' must be true or false");
    recipe->instrument.offset = *offset->value<bool>();
  }
}

}  // namespace lobefit
