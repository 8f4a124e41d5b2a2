// From files to a fitted material by the options of `lobefit fit`: what the verbs fit and batch share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "options/measurement_options.h"
#include "options/recipe_options.h"
#include <CLI/CLI.hpp>

#include "lobefit/fit/fit.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

struct FitFileOptions {
  MeasurementOptions measurement;
  RecipeOptions recipe;
  FitOptions fit;
  std::optional<std::size_t> starts;  // FitOptions::starts and seed, where they were given
  std::optional<std::uint64_t> seed;

  // The object must outlive the parsing.
  void AddTo(CLI::App* app);
};

struct FittedFile {
  Measurement measurement;  // without what was set aside
  Material material;
};

// Whether the input is a material, to which lobes are fitted.
bool IsOneMaterial(const std::vector<std::string>& files);

// Reads the files as one measurement, selects, chooses the recipe, fits. `command` is recorded in the material. Throws
// UsageError and InputError.
FittedFile FitFile(const FitFileOptions& options, const std::vector<std::string>& files, int threads,
                   const std::string& command);

// Why a result is not to be trusted, for people; empty where it is. Exit code 4 says the same to programs.
std::string DoubtsAbout(const Material& material);

}  // namespace lobefit
