// lobefit compare: several recipes on one measurement, side by side; the recommended one becomes NAME.material.json.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "options/measurement_options.h"
#include "options/recipe_options.h"
#include "text/comparison_text.h"
#include "text/output.h"
#include "verbs/verb.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/export/import.h"
#include "lobefit/fit/compare.h"
#include "lobefit/fit/fit.h"
#include "lobefit/fit/sel/slice.h"
#include "lobefit/io/series.h"
#include "lobefit/material/json.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/report/comparison/comparison.h"

namespace lobefit {
namespace {

struct CompareVerb {
  MeasurementOptions measurement;
  RecipeOverrides overrides;
  CompareOptions compare;
  std::vector<std::string> files;
  std::string out = ".", name, recipes;
  std::vector<std::string> with;
  bool no_report = false;
};

// Whether most incident directions have three values for each parameter of their lobes, and there are some to
// interpolate between. Lobes of hundreds of channels take minutes (6 of processor time for 780 samples of 800, with
// folds), so that they are fitted where --recipes asks for them.
bool CanFeedLobes(const Measurement& measurement, const SelRecipe& sel) {
  constexpr std::size_t kMostChannels = 64;
  const std::size_t channels = measurement.channels.size();
  if (channels > kMostChannels) return false;
  const Incidences incidences = GroupByIncidence(measurement);
  std::vector<std::size_t> count(incidences.wi.size());
  for (const auto group : incidences.group) ++count[group];
  const std::size_t needed = 3 * SelFreeParameters(sel.lobes, channels);
  const auto enough = std::count_if(count.begin(), count.end(), [&](std::size_t n) { return n * channels >= needed; });
  return enough >= 3 && 2 * static_cast<std::size_t>(enough) > count.size();
}

// What is worth comparing on a measurement: from the simplest model to the richest that it can determine, a second
// lobe, and lobes for each incident direction, whose error shows how much of the data no such model describes.
std::vector<std::string> DefaultRecipes(const Measurement& measurement, const MeasurementTraits& traits) {
  std::vector<std::string> names = {"ggx", "ggx-anisotropic", "ellipsoid", "ggx-two-lobes"};
  if (traits.in_plane) names = {"ggx", "auto", "ggx-two-lobes"};
  if (traits.isotropic) names = {"ggx", "ggx-two-lobes"};
  if (CanFeedLobes(measurement, *LoadRecipe("sel").sel)) names.emplace_back("sel");
  return names;
}

Recipe NamedRecipe(const std::string& name, const MeasurementTraits& traits) {
  if (name == "auto") return AutomaticRecipe(traits);
  std::vector<std::string> names = RecipeNames();
  const bool known = std::find(names.begin(), names.end(), name) != names.end();
  const bool path = name.find('/') != std::string::npos || name.ends_with(".toml") || std::filesystem::exists(name);
  if (!known && !path) {
    names.insert(names.begin(), "auto");
    throw UsageError(fmt::format("--recipes: '{}' is neither a recipe nor a file{}; allowed: {}, or a .toml file",
                                 Excerpt(name), DidYouMean(name, names), Join(names)));
  }
  return LoadRecipe(name);
}

std::vector<Recipe> ChooseRecipes(const CompareVerb& verb, const Measurement& measurement) {
  const MeasurementTraits traits = TraitsOf(measurement);
  std::vector<std::string> names;
  for (const std::string_view piece : Split(verb.recipes, ',')) {
    const std::string name(Trim(piece));
    if (name.empty() && !verb.recipes.empty()) throw UsageError("--recipes has an empty name; write a,b,c");
    if (name.empty()) continue;
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw UsageError(fmt::format("--recipes names '{}' twice", Excerpt(name)));
    names.push_back(name);
  }
  if (names.empty()) names = DefaultRecipes(measurement, traits);
  std::vector<Recipe> recipes;
  for (const std::string& name : names) {
    Recipe recipe = NamedRecipe(name, traits);
    recipe.plane_azimuth = traits.plane_azimuth;
    verb.overrides.Apply(&recipe);
    recipes.push_back(recipe);
  }
  return recipes;
}

// A document of this program, or a material of a renderer as that evaluates it.
GivenMaterial LoadGiven(const std::string& path) {
  const ImportedMaterial imported = ImportMaterial(path);
  if (imported.format == "json") return {path, ReadMaterial(path)};
  GivenMaterial given = {path, {}, imported.brdf};
  given.material.model.diffuse = Diffuse::kNone;
  given.material.channels = imported.channels.names;
  given.material.wavelengths_nm = imported.channels.wavelengths_nm;
  given.material.source.format = imported.format;
  given.material.termination = {true, true, "not fitted"};
  // What was assumed or left out of the file; people see it, documents keep it.
  given.material.remarks = imported.remarks;
  for (const std::string& remark : imported.remarks) Print(fmt::format("lobefit: {}: {}\n", path, remark), stderr);
  return given;
}

// The picture of the recommended model and the next best ones by held-out error; foreign materials have no place in its
// panels. Empty where no picture was drawn.
std::string DrawPicture(const Comparison& comparison, const Measurement& measurement, const std::filesystem::path& path,
                        int threads) {
  std::vector<std::size_t> order;
  for (std::size_t m = 0; m < comparison.models.size(); ++m) {
    if (!comparison.models[m].brdf) order.push_back(m);
  }
  const auto rank = [&](std::size_t m) {
    const double held_out = comparison.models[m].held_out;
    return m == comparison.recommended ? -1.0 : std::isfinite(held_out) ? held_out : 1e300;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  if (order.size() > kMostCompared) order.resize(kMostCompared);
  std::vector<ComparedModel> models;
  for (const std::size_t m : order) {
    const JudgedModel& model = comparison.models[m];
    models.push_back({&model.material, std::filesystem::path(model.name).filename().string(),
                      std::isfinite(model.held_out) ? fmt::format("held-out {:.3g}", model.held_out) : ""});
  }
  if (models.empty()) return "";
  ReportOptions options;
  options.threads = threads;
  WriteComparisonPng(models, measurement, path, options);
  return fmt::format("Picture: {}\n", path.string());
}

int RunCompare(const CompareVerb& verb, const CommonOptions& common) {
  const std::filesystem::path folder = verb.out;

  const std::string name = ResultName(verb.name, SeriesName(verb.files));
  MakeFolder(folder);
  const std::filesystem::path document = folder / (name + ".material.json"),
                              picture_file = folder / (name + ".compare.png");
  std::vector<std::filesystem::path> inputs = InputPaths(verb.files);
  inputs.insert(inputs.end(), verb.with.begin(), verb.with.end());
  CheckOutput(document, inputs);
  if (!verb.no_report) CheckOutput(picture_file, inputs);

  const auto start = std::chrono::steady_clock::now();
  std::vector<GivenMaterial> given;
  for (const std::string& path : verb.with) given.push_back(LoadGiven(path));
  Measurement measurement = verb.measurement.LoadStated(verb.files);
  const double read_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  CompareOptions options = verb.compare;
  options.fit.threads = common.Threads();
  const std::vector<Recipe> recipes = ChooseRecipes(verb, measurement);
  const auto free_scale = std::find_if(recipes.begin(), recipes.end(), [](const Recipe& r) { return r.free_scale; });
  if (free_scale != recipes.end()) RemarkFreeScale(*free_scale, &measurement);
  Comparison comparison = Compare(recipes, given, options, &measurement);

  Material& material = comparison.models[comparison.recommended].material;
  material.command = common.command;
  if (material.used) material.used->reading = verb.measurement.Words();
  material.timings_s["read"] = read_s;
  material.recipe_reason = comparison.reason;
  // The document first: it is kept even where drawing fails.
  WriteMaterial(material, document);
  std::string picture;
  if (!verb.no_report) picture = DrawPicture(comparison, measurement, picture_file, options.fit.threads);
  const ComparisonContext context = {measurement.source, measurement.sha256, measurement.format, common.command,
                                     document.string()};
  if (common.json) {
    fmt::print("{}", ComparisonJson(comparison, context));
  } else {
    Print(fmt::format("{}Result:  {}\n{}", ComparisonText(comparison, context), PrintableName(document), picture));
  }
  if (material.termination.converged && material.termination.determined) return kExitDone;
  std::fputs("lobefit: no recipe converged and is determined by the measurement; try a simpler one in --recipes\n",
             stderr);
  return kExitFit;
}

}  // namespace

std::function<int()> SetUpCompare(CLI::App* app, CommonOptions* common) {
  auto verb = std::make_shared<CompareVerb>();
  const std::string group = "What to compare";
  app->add_option(
         "FILE", verb->files,
         "measurement files: one, or several and folders as one measurement; FILE:theta_i=30 states what a file lacks")
      ->required();
  app->add_option("--recipes", verb->recipes,
                  "recipes by name or .toml file, with commas between (default: what suits the measurement)")
      ->group(group);
  app->add_option("--with", verb->with,
                  "a *.material.json, or a material of pbrt-v4, Mitsuba, MaterialX, glTF, an RGL or MERL table, to "
                  "compare with as it is; may be given again")
      ->group(group);
  verb->overrides.AddTo(app, group);
  app->add_option("--folds", verb->compare.folds,
                  "folds over the incident directions for the held-out error (default 5; 0: none)")
      ->check(CLI::Range(0, 1000));
  app->add_option("--out", verb->out, "folder of the results (default: the current one)");
  app->add_option("--name", verb->name, "NAME of the results (default: the file's name without its ending)");
  app->add_flag("--no-report", verb->no_report, "write no picture");
  app->add_option("--starts", verb->compare.fit.starts, "descents from the best-ranked starts (default 8)")
      ->check(CLI::Range(1, 100000));
  app->add_option("--seed", verb->compare.fit.seed, "seed of the folds and subsamples (default 1)");
  verb->measurement.AddTo(app);
  return [=] { return RunCompare(*verb, *common); };
}

}  // namespace lobefit
