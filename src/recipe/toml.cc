#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/files/toml_file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/core/fresnel/optical_constants.h"
#include "lobefit/math/vec.h"
#include "lobefit/recipe/free_scale.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {
namespace {

std::optional<double> Number(const toml::table& table, const char* key, const TomlFile& place) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  const std::optional<double> value = node->value<double>();
  if (!value || !node->is_number() || !std::isfinite(*value)) {
    place.Fail(node->source(), fmt::format("'{}' must be a finite number", key));
  }
  return value;
}

template <class Enum>
void ReadChoice(const toml::table& table, const char* key, const std::vector<Choice<Enum>>& choices,
                const TomlFile& place, Enum* value) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return;
  const std::optional<std::string> text = node->value<std::string>();
  const Choice<Enum>* choice = text && node->is_string() ? Find(choices, *text) : nullptr;
  if (choice == nullptr) {
    const std::vector<std::string> names = Names(choices);
    place.Fail(node->source(), fmt::format("{} = '{}' is unknown{}; allowed: {}", key, text.value_or("?"),
                                           DidYouMean(text.value_or(""), names), Join(names)));
  }
  *value = choice->value;
}

const toml::table* Table(const toml::table& table, const char* key, const TomlFile& place) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) place.Fail(node->source(), fmt::format("'{}' must be a table", key));
  return node->as_table();
}

// A number or, where `per_channel`, a list of numbers; times `factor`.
std::vector<double> Numbers(const toml::table& table, const char* key, bool per_channel, double factor,
                            const TomlFile& place) {
  std::vector<double> numbers;
  const toml::node* node = table.get(key);
  if (node == nullptr) return numbers;
  const toml::array* array = node->as_array();
  if (array == nullptr) return {*Number(table, key, place) * factor};
  for (const toml::node& entry : *array) {
    const std::optional<double> value = entry.value<double>();
    if (!per_channel || !value || !entry.is_number() || !std::isfinite(*value)) {
      place.Fail(node->source(), fmt::format("'{}' must be a finite number{}", key,
                                             per_channel ? " or a list of them, one a channel" : ""));
    }
    numbers.push_back(*value * factor);
  }
  if (numbers.empty()) place.Fail(node->source(), fmt::format("'{}' is an empty list", key));
  return numbers;
}

// One parameter: { start, fixed, bounds = [low, high], shared, free }.
ParameterRecipe ReadParameter(const toml::node& node, const Parameter& parameter, const TomlFile& place) {
  const std::string& name = parameter.json_name;
  if (!node.is_table()) {
    place.Fail(
        node.source(),
        fmt::format("'{}' must be a table such as {{ start = 0.2 }}; keys: start, fixed, bounds, shared, free", name));
  }
  const toml::table& table = *node.as_table();
  place.CheckKeys(table, {"start", "fixed", "bounds", "shared", "free"}, "of parameter '" + name + "'");
  const double factor = InsideFactor(parameter);
  ParameterRecipe recipe;
  recipe.shared = parameter.shared;
  recipe.start = Numbers(table, "start", parameter.per_channel, factor, place);
  recipe.fixed = Numbers(table, "fixed", parameter.per_channel, factor, place);
  if (const toml::node* bounds = table.get("bounds")) {
    const toml::array* array = bounds->as_array();
    const bool two_numbers =
        array != nullptr && array->size() == 2 && array->get(0)->is_number() && array->get(1)->is_number();
    if (!two_numbers)
      place.Fail(bounds->source(), fmt::format("bounds of '{}' must be two numbers, [low, high]", name));
    recipe.low = *array->get(0)->value<double>() * factor;
    recipe.high = *array->get(1)->value<double>() * factor;
    if (!std::isfinite(*recipe.low) || !std::isfinite(*recipe.high))
      place.Fail(bounds->source(), fmt::format("bounds of '{}' must be finite numbers", name));
    if (!(*recipe.low < *recipe.high))
      place.Fail(bounds->source(), fmt::format("bounds of '{}': the first must be below the second", name));
    const bool wider = parameter.group == ParameterGroup::kShape && *recipe.high > parameter.high + 1e-12;
    if (*recipe.low < parameter.low - 1e-12 || wider) {
      place.Fail(bounds->source(), fmt::format("bounds of '{}' leave its range [{:g}, {:g}]", name,
                                               parameter.low / factor, parameter.high / factor));
    }
  }
  if (const toml::node* shared = table.get("shared")) {
    if (!shared->is_boolean()) place.Fail(shared->source(), "'shared' must be true or false");
    recipe.shared = *shared->value<bool>();
    if (recipe.shared && !parameter.per_channel)
      place.Fail(shared->source(), fmt::format("'{}' has one value for all channels anyway", name));
  }
  if (!recipe.fixed.empty() && (!recipe.start.empty() || recipe.low))
    place.Fail(node.source(), fmt::format("'{}' is fixed: start and bounds do not apply", name));
  if (const toml::node* free = table.get("free")) {
    if (!free->is_boolean() || !*free->value<bool>())
      place.Fail(free->source(), fmt::format("'free' of '{}' must be true; {{ fixed = ... }} fixes it", name));
    recipe.free = true;
  }
  const bool may_be_free = parameter.free || parameter.group != ParameterGroup::kShape;
  if (recipe.free && (!may_be_free || !recipe.fixed.empty())) {
    place.Fail(node.source(), recipe.fixed.empty()
                                  ? fmt::format("'{}' is not a free parameter of this ndf; it can only be fixed", name)
                                  : fmt::format("'{}' is both fixed and free", name));
  }
  if (!parameter.free && !recipe.free && (!recipe.start.empty() || recipe.low || recipe.shared != parameter.shared)) {
    place.Fail(node.source(),
               may_be_free ? fmt::format("'{}' is not fitted unless it has free = true", name)
                           : fmt::format("'{}' is not a free parameter of this ndf; it can only be fixed", name));
  }
  for (const std::vector<double>& values : {recipe.start, recipe.fixed}) {
    for (const double value : values) {
      const double low = recipe.low.value_or(parameter.low), high = recipe.high.value_or(parameter.high);
      if (value < low - 1e-12 || value > high + 1e-12) {
        place.Fail(node.source(), fmt::format("'{}' = {:g} lies outside its bounds [{:g}, {:g}]", name, value / factor,
                                              low / factor, high / factor));
      }
    }
  }
  return recipe;
}

Lobe ReadLobe(const toml::table& table, const TomlFile& place) {
  place.CheckKeys(table, {"ndf", "masking", "fresnel", "metal", "direction", "knots"}, "of a lobe");
  Lobe lobe;
  ReadChoice(table, "ndf", NdfChoices(), place, &lobe.ndf);
  if (FamilyOf(lobe.ndf) == Family::kAbg) {  // which go with no others
    lobe.masking = Masking::kNone;
    lobe.fresnel = Fresnel::kNone;
  }
  ReadChoice(table, "masking", MaskingChoices(), place, &lobe.masking);
  ReadChoice(table, "fresnel", FresnelChoices(), place, &lobe.fresnel);
  ReadChoice(table, "direction", LobeDirectionChoices(), place, &lobe.direction);
  if (const toml::node* knots = table.get("knots")) {
    try {
      lobe.grid = GridWithKnots(Numbers(table, "knots", true, 1, place));
    } catch (const InputError& error) {
      place.Fail(knots->source(), error.what());
    }
  }
  if (const toml::node* metal = table.get("metal")) {
    std::vector<std::string> names;
    for (const MetalInfo& info : Metals()) {
      names.push_back(info.symbol);
      if (info.name != info.symbol) names.push_back(info.name);
    }
    lobe.metal = metal->value<std::string>().value_or("?");
    if (!metal->is_string() || std::find(names.begin(), names.end(), lobe.metal) == names.end()) {
      place.Fail(metal->source(), fmt::format("metal = '{}' is unknown{}; allowed: {}", lobe.metal,
                                              DidYouMean(lobe.metal, names), Join(names)));
    }
  }
  return lobe;
}

void ReadLoss(const toml::table& root, const TomlFile& place, Recipe* recipe) {
  const toml::table* loss = Table(root, "loss", place);
  if (loss == nullptr) return;
  place.CheckKeys(*loss, {"kind", "scale"}, "of the loss");
  ReadChoice(*loss, "kind", LossChoices(), place, &recipe->loss);
  if (const std::optional<double> scale = Number(*loss, "scale", place)) {
    if (*scale <= 0) place.Fail(loss->source(), "the scale of the loss must be above 0");
    recipe->loss_scale = *scale;
  }
}

// An angle in degrees of { value, across, prior_deg }; above 0, as 0 is allowed for the value alone.
std::optional<double> DiscAngle(const toml::table& table, const char* key, const char* disc, const char* meaning,
                                const TomlFile& place) {
  const std::optional<double> degrees = Number(table, key, place);
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
    degrees = Number(*table, "value", place);
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
    degrees = Number(instrument, key, place);
  }
  const double highest = RadiansToDegrees(kLargestHalfAngle);
  if (!(*degrees >= 0 && *degrees <= highest + 1e-9)) {
    place.Fail(node->source(), fmt::format("{} = {:g}: the half angle of a disc, in degrees, must lie in [0, {:g}]",
                                           key, *degrees, highest));
  }
  *half_angle = DegreesToRadians(*degrees);
}

void ReadInstrument(const toml::table& root, const TomlFile& place, Recipe* recipe) {
  const toml::table* table = Table(root, "instrument", place);
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
  if (const toml::table* noise = Table(*table, "noise", place)) {
    place.CheckKeys(*noise, {"floor", "relative", "poisson"}, "of the noise");
    const double floor = Number(*noise, "floor", place).value_or(0),
                 poisson = Number(*noise, "poisson", place).value_or(0),
                 relative = Number(*noise, "relative", place).value_or(0);
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
  if (const toml::table* alignment = Table(*table, "alignment", place)) {
    place.CheckKeys(*alignment, {"prior_deg"}, "of the alignment");
    const double prior = Number(*alignment, "prior_deg", place).value_or(RadiansToDegrees(AlignmentRecipe().prior));
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

// A recipe of a table of lobes: what belongs to a model has no place in it.
Recipe ReadSelRecipe(const toml::table& root, const TomlFile& place) {
  const toml::table& table = *Table(root, "sel", place);
  place.CheckKeys(root, {"name", "metric", "weighting", "theta_max_deg", "sel"}, "of a recipe with [sel]");
  place.CheckKeys(table, {"lobes", "quantity", "bound", "drift"}, "of [sel]");
  SelRecipe sel;
  if (const std::optional<double> lobes = Number(table, "lobes", place)) {
    if (*lobes != 1 && *lobes != 2 && *lobes != 3)
      place.Fail(table.get("lobes")->source(), fmt::format("lobes = {:g}: allowed are 1, 2 and 3", *lobes));
    sel.lobes = static_cast<std::size_t>(*lobes);
  }
  static const std::vector<Choice<SelQuantity>> quantities = {
      {SelQuantity::kBrdf, NameOf(SelQuantity::kBrdf), ""},
      {SelQuantity::kBrdfCosineO, NameOf(SelQuantity::kBrdfCosineO), ""}};
  ReadChoice(table, "quantity", quantities, place, &sel.quantity);
  if (const toml::node* bound = table.get("bound")) {
    if (!bound->is_boolean()) place.Fail(bound->source(), "'bound' must be true or false");
    sel.bound = *bound->value<bool>();
  }
  if (const std::optional<double> drift = Number(table, "drift", place)) {
    if (*drift <= 0) place.Fail(table.get("drift")->source(), "'drift' must be above 0");
    sel.drift = *drift;
  }
  Model model;
  model.diffuse = Diffuse::kNone;
  Recipe recipe = DefaultRecipe(model, std::filesystem::path(place.name).stem().string());
  recipe.sel = sel;
  return recipe;
}

bool IsScaleFree(const toml::table& root, const TomlFile& place, const Recipe& recipe) {
  const toml::node* node = root.get("scale");
  if (node == nullptr) return false;
  const std::string text = node->value<std::string>().value_or("?");
  if (text != "free" && text != "calibrated")
    place.Fail(node->source(), fmt::format("scale = '{}' is unknown; allowed: calibrated, free", Excerpt(text)));
  if (text == "free" && recipe.energy == EnergyChoice::kConserving)
    place.Fail(node->source(), "values without a scale have no albedo that energy = \"conserving\" could limit");
  return text == "free";
}

// The part of a recipe that names a model.
Recipe ReadModelRecipe(const toml::table& root, const TomlFile& place) {
  place.CheckKeys(root,
                  {"name", "metric", "weighting", "energy", "scale", "loss", "theta_max_deg", "wavelengths_nm",
                   "diffuse", "instrument", "lobe", "parameters", "sel"},
                  "of a recipe");
  Model model;
  if (const toml::node* lobes = root.get("lobe")) {
    const toml::array* array = lobes->as_array();
    if (array == nullptr || !array->is_array_of_tables() || array->size() > 3) {
      place.Fail(lobes->source(), "lobes are written as [[lobe]], at most three");
    }
    for (const toml::node& lobe : *array) model.lobes.push_back(ReadLobe(*lobe.as_table(), place));
  }
  if (model.lobes.empty()) place.Fail(root.source(), "a recipe needs at least one [[lobe]], or [sel]");
  ReadChoice(root, "diffuse", DiffuseChoices(), place, &model.diffuse);
  if (const std::string why = WhyNotEvaluable(model); !why.empty()) place.Fail(root.get("lobe")->source(), why);
  return DefaultRecipe(model, std::filesystem::path(place.name).stem().string());
}

}  // namespace

Recipe ParseRecipe(const std::string& toml_text, const std::string& file_name) {
  const TomlFile place{file_name};
  const toml::table root = place.Parse(toml_text);
  Recipe recipe = root.contains("sel") ? ReadSelRecipe(root, place) : ReadModelRecipe(root, place);
  if (const toml::node* name = root.get("name")) {
    if (!name->is_string()) place.Fail(name->source(), "'name' must be a string");
    recipe.name = *name->value<std::string>();
  }
  ReadChoice(root, "metric", MetricChoices(), place, &recipe.metric);
  recipe.metric_given = root.contains("metric");
  ReadChoice(root, "weighting", WeightingChoices(), place, &recipe.weighting);
  ReadChoice(root, "energy", EnergyChoices(), place, &recipe.energy);
  ReadLoss(root, place, &recipe);
  ReadInstrument(root, place, &recipe);
  if (const std::optional<double> limit = Number(root, "theta_max_deg", place)) {
    if (*limit <= 0 || *limit > 90)
      place.Fail(root.get("theta_max_deg")->source(), "theta_max_deg must lie in (0, 90]");
    recipe.theta_max = DegreesToRadians(*limit);
  }
  recipe.wavelengths_nm = Numbers(root, "wavelengths_nm", true, 1, place);
  if (const toml::table* table = Table(root, "parameters", place)) {
    const std::vector<Parameter> parameters = Parameters(recipe.model);
    const std::size_t coat = CoatOf(recipe.model);
    std::vector<std::string> names;
    for (const Parameter& parameter : parameters) names.push_back(parameter.json_name);
    place.CheckKeys(*table, names, "of this model's parameters");
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (const toml::node* node = table->get(names[i]))
        recipe.parameters[i] = ReadParameter(*node, parameters[i], place);
      const bool of_coat = coat < recipe.model.lobes.size() && i == FirstFresnel(recipe.model, coat);
      if (of_coat && (!recipe.parameters[i].shared || recipe.parameters[i].fixed.size() > 1 ||
                      recipe.parameters[i].start.size() > 1)) {
        place.Fail(table->get(names[i])->source(),
                   fmt::format("'{}' of a coat is one for all channels, which pass it on one way", names[i]));
      }
    }
  }
  return IsScaleFree(root, place, recipe) ? WithFreeScale(recipe) : recipe;
}

Recipe ReadRecipe(const std::filesystem::path& path) {
  const FileBytes file(path);
  return ParseRecipe(std::string(file.bytes()), path.string());
}

}  // namespace lobefit
