// The recipe of a fit from the command line: by name or file, or automatic, with single choices overridden.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "options/instrument_options.h"
#include <CLI/CLI.hpp>

#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// A recipe file, a recipe of the library by its name ("ellipsoid"), or that of a *.material.json. Throws InputError
// that lists the names.
Recipe LoadRecipe(const std::string& name_or_path);

// Single choices that override those of a recipe.
class RecipeOverrides {
 public:
  void AddTo(CLI::App* app, const std::string& group);
  // Throws UsageError.
  void Apply(Recipe* recipe) const;
  bool HasFreeScale() const { return scale_ == "free"; }

 private:
  std::string metric_, weighting_, energy_, scale_;
  double theta_max_deg_ = 0;
};

class RecipeOptions {
 public:
  void AddTo(CLI::App* app);
  bool IsAutomatic() const { return recipe_ == "auto"; }
  // Reads the recipe once for all that follows, whatever becomes of its file: for many fits. Throws InputError.
  void Keep();
  // Throws UsageError and InputError.
  Recipe Choose(const Measurement& measurement) const;
  const RecipeOverrides& overrides() const { return overrides_; }
  // Where the recipe is a document's: what repeats its fit.
  std::optional<RecipeUsed> UsedByDocument() const;
  const std::string& name() const { return recipe_; }
  // The recipe as text, or that it is chosen by the measurement: what decides the fit beside the other options. Throws
  // as Choose.
  std::string Resolved() const;

 private:
  Recipe Named() const { return kept_ ? *kept_ : LoadRecipe(recipe_); }

  std::string recipe_ = "auto";
  std::optional<Recipe> kept_;
  std::optional<RecipeUsed> kept_use_;  // of `kept_`, where it is a document's
  RecipeOverrides overrides_;
  InstrumentOptions instrument_;
};

// Where the recipes of the library are: beside the installed program, else in the source tree that built it.
std::filesystem::path RecipeFolder();
// Names of the recipes of the library, sorted.
std::vector<std::string> RecipeNames();

// What a validation fits: the truth's own model unless a recipe is given.
class FittedModel {
 public:
  void AddTo(CLI::App* app);
  Recipe Choose(const Model& truth) const;

 private:
  std::string recipe_, metric_;
  InstrumentOptions instrument_;
};

// Says in the measurement, and so in every result, what the values are taken for where the recipe's scale is free.
void RemarkFreeScale(const Recipe& recipe, Measurement* measurement);

}  // namespace lobefit
