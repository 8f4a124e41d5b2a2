#include "options/recipe_options.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "options/number_option.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/fit/automatic.h"
#include "lobefit/fit/fit.h"
#include "lobefit/material/json.h"
#include "lobefit/math/vec.h"
#include "lobefit/recipe/free_scale.h"

namespace lobefit {
namespace {

template <class Enum>
void Override(const std::string& text, const char* option, const std::vector<Choice<Enum>>& choices, Enum* value) {
  if (text.empty()) return;
  const Choice<Enum>* choice = Find(choices, text);
  if (choice == nullptr) {
    const std::vector<std::string> names = Names(choices);
    throw UsageError(
        fmt::format("{} '{}' is unknown{}; allowed: {}", option, Excerpt(text), DidYouMean(text, names), Join(names)));
  }
  *value = choice->value;
}

bool IsDocument(const std::string& name_or_path) {
  std::error_code error;
  return std::filesystem::is_regular_file(name_or_path, error) && LooksLikeMaterial(name_or_path);
}

const RecipeUsed& UsedBy(const Material& document, const std::string& path) {
  if (!document.used) {
    throw InputError(
        Excerpt(path, 200) +
        ": does not hold its recipe (an earlier version wrote it, or no fit); give a recipe by name or file");
  }
  return *document.used;
}

}  // namespace

std::filesystem::path RecipeFolder() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    std::filesystem::path installed = program.parent_path().parent_path() / "share" / "lobefit" / "fits";
    if (std::filesystem::is_directory(installed, error)) return installed;
  }
  return LOBEFIT_SOURCE_FITS;
}

std::vector<std::string> RecipeNames() {
  std::error_code error;
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(RecipeFolder(), error)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Recipe LoadRecipe(const std::string& name_or_path) {
  std::error_code error;
  if (IsDocument(name_or_path)) {
    const Material document = ReadMaterial(name_or_path);
    Recipe recipe = ParseRecipe(UsedBy(document, name_or_path).text, name_or_path + ", recipe");
    recipe.reason = document.recipe_reason;
    return recipe;
  }
  // A folder that has the name of a recipe does not stand in its way.
  if (std::filesystem::exists(name_or_path, error) && !std::filesystem::is_directory(name_or_path, error))
    return ReadRecipe(name_or_path);
  const std::filesystem::path folder = RecipeFolder();
  const std::filesystem::path named = folder / (name_or_path + ".toml");
  if (name_or_path.find('/') == std::string::npos && std::filesystem::exists(named, error)) return ReadRecipe(named);
  const std::vector<std::string> names = RecipeNames();
  throw InputError(fmt::format("recipe '{}' is neither a file nor a recipe of {}{}; allowed: auto, {}",
                               Excerpt(name_or_path), folder.string(), DidYouMean(name_or_path, names), Join(names)));
}

void RecipeOverrides::AddTo(CLI::App* app, const std::string& group) {
  app->add_option("--metric", metric_, "overrides the recipe: " + Join(Names(MetricChoices())))->group(group);
  app->add_option("--weighting", weighting_, "overrides the recipe: " + Join(Names(WeightingChoices())))->group(group);
  app->add_option("--energy", energy_,
                  "overrides the recipe: free (default), or conserving: the albedo stays at most 1 at the measured "
                  "incident directions")
      ->group(group);
  app->add_option("--theta-max", theta_max_deg_,
                  "overrides the recipe: limit on both polar angles, degrees (default 80)")
      ->check(Within(0.1, 90))
      ->group(group);
  app->add_option(
         "--scale", scale_,
         "calibrated (default): values are f_r in 1/sr; free: their scale is not known, so the shape is fitted "
         "without the bounds that calibrated values have")
      ->check(CLI::IsMember({"calibrated", "free"}))
      ->group(group);
}

void RecipeOverrides::Apply(Recipe* recipe) const {
  Override(metric_, "--metric", MetricChoices(), &recipe->metric);
  recipe->metric_given = recipe->metric_given || !metric_.empty();
  Override(weighting_, "--weighting", WeightingChoices(), &recipe->weighting);
  if (theta_max_deg_ > 0) recipe->theta_max = DegreesToRadians(theta_max_deg_);
  Override(energy_, "--energy", EnergyChoices(), &recipe->energy);
  if (recipe->energy == EnergyChoice::kConserving) {
    if (recipe->sel) throw UsageError("--energy conserving is for models; a recipe with [sel] fits a table of lobes");
    if (scale_ == "free" || recipe->free_scale) {
      throw UsageError(
          "--scale free says that the values are not calibrated, so no albedo follows from them and energy "
          "'conserving' has no meaning; leave one of the two out");
    }
  }
  if (scale_ == "calibrated" && recipe->free_scale) {
    throw UsageError("recipe '" + recipe->name +
                     "' says that the scale of the values is free; take a recipe without, or leave --scale out");
  }
  if (scale_ == "free") *recipe = WithFreeScale(*recipe);
}

void RemarkFreeScale(const Recipe& recipe, Measurement* measurement) {
  if (!recipe.free_scale) return;
  measurement->conventions["scale"] = "free (option)";
  measurement->remarks.emplace_back(
      "the scale of the values is not known (--scale free): the shape is fitted, amplitudes stand relative to each "
      "other, and no reflectance or albedo follows from them");
}

void RecipeOptions::AddTo(CLI::App* app) {
  const std::string group = "What to fit";
  app->add_option(
         "--recipe", recipe_,
         "a recipe by name, a .toml file, or a *.material.json whose fit is repeated; 'auto' (default) takes what "
         "the measurement can determine")
      ->group(group);
  overrides_.AddTo(app, group);
  instrument_.AddTo(app);
}

void RecipeOptions::Keep() {
  if (IsAutomatic()) return;
  kept_use_ = UsedByDocument();
  kept_ = LoadRecipe(recipe_);
}

Recipe RecipeOptions::Choose(const Measurement& measurement) const {
  Recipe recipe = IsAutomatic() ? ChooseAutomatically(measurement) : Named();
  recipe.plane_azimuth = TraitsOf(measurement).plane_azimuth;
  overrides_.Apply(&recipe);
  instrument_.Apply(&recipe);
  return recipe;
}

std::string RecipeOptions::Resolved() const {
  Recipe recipe = IsAutomatic() ? Recipe() : Named();
  overrides_.Apply(&recipe);
  if (IsAutomatic()) return "recipe = auto\n";
  std::string text = ToToml(recipe);
  if (const std::optional<RecipeUsed> used = UsedByDocument()) {
    text +=
        fmt::format("starts = {}\nseed = {}\nscouting_steps = {}\n", used->starts, used->seed, used->scouting_steps);
    for (const auto& [option, word] : used->reading) text += option + " = " + word + "\n";
  }
  return text;
}

std::optional<RecipeUsed> RecipeOptions::UsedByDocument() const {
  if (kept_) return kept_use_;
  if (IsAutomatic() || !IsDocument(recipe_)) return std::nullopt;
  return UsedBy(ReadMaterial(recipe_), recipe_);
}

void FittedModel::AddTo(CLI::App* app) {
  const std::string group = "What to fit";
  app->add_option("--recipe", recipe_, "a recipe by name or a .toml file (default: the truth's model)")->group(group);
  app->add_option("--metric", metric_, "overrides the recipe: " + Join(Names(MetricChoices())))->group(group);
  // The mean is that of the synthetic readings.
  instrument_.AddTo(app, false);
}

Recipe FittedModel::Choose(const Model& truth) const {
  Recipe recipe = recipe_.empty() ? DefaultRecipe(truth, "model of the truth") : LoadRecipe(recipe_);
  Override(metric_, "--metric", MetricChoices(), &recipe.metric);
  recipe.metric_given = recipe.metric_given || !metric_.empty();
  instrument_.Apply(&recipe);
  return recipe;
}

}  // namespace lobefit
