#include <algorithm>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/core/fresnel/optical_constants.h"
#include "lobefit/math/vec.h"
#include "lobefit/recipe/free_scale.h"
#include "lobefit/recipe/recipe.h"
#include "lobefit/recipe/toml_instrument.h"
#include "lobefit/recipe/toml_parameter.h"
#include "lobefit/recipe/toml_values.h"

namespace lobefit {
namespace {

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
      lobe.grid = GridWithKnots(NumberList(table, "knots", true, 1, place));
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
  const toml::table* loss = TableOf(root, "loss", place);
  if (loss == nullptr) return;
  place.CheckKeys(*loss, {"kind", "scale"}, "of the loss");
  ReadChoice(*loss, "kind", LossChoices(), place, &recipe->loss);
  if (const std::optional<double> scale = OptionalNumber(*loss, "scale", place)) {
    if (*scale <= 0) place.Fail(loss->source(), "the scale of the loss must be above 0");
    recipe->loss_scale = *scale;
  }
}

// A recipe of a table of lobes: what belongs to a model has no place in it.
Recipe ReadSelRecipe(const toml::table& root, const TomlFile& place) {
  const toml::table& table = *TableOf(root, "sel", place);
  place.CheckKeys(root, {"name", "metric", "weighting", "theta_max_deg", "sel"}, "of a recipe with [sel]");
  place.CheckKeys(table, {"lobes", "quantity", "bound", "drift"}, "of [sel]");
  SelRecipe sel;
  if (const std::optional<double> lobes = OptionalNumber(table, "lobes", place)) {
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
  if (const std::optional<double> drift = OptionalNumber(table, "drift", place)) {
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
  if (const std::optional<double> limit = OptionalNumber(root, "theta_max_deg", place)) {
    if (*limit <= 0 || *limit > 90)
      place.Fail(root.get("theta_max_deg")->source(), "theta_max_deg must lie in (0, 90]");
    recipe.theta_max = DegreesToRadians(*limit);
  }
  recipe.wavelengths_nm = NumberList(root, "wavelengths_nm", true, 1, place);
  for (const double wavelength : recipe.wavelengths_nm) {
    if (wavelength <= 0)
      place.Fail(root.get("wavelengths_nm")->source(),
                 fmt::format("a wavelength of {:g} nm; it must be above 0", wavelength));
  }
  if (const toml::table* table = TableOf(root, "parameters", place)) {
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
