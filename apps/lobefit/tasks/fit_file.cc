#include "tasks/fit_file.h"

#include <chrono>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/fit/instrument.h"
#include "lobefit/fit/ladder.h"
#include "lobefit/fit/last_descent.h"
#include "lobefit/fit/sel/sampling.h"
#include "lobefit/io/series.h"
#include "lobefit/material/json.h"

namespace lobefit {
namespace {

// What a material gives on hemispheres, in place of a measurement.
Measurement Sampled(const FitFileOptions& options, const std::string& file) {
  Measurement measurement = SampleForSel(ReadModelMaterial(file));
  measurement.source = std::filesystem::path(file).filename().string();
  measurement.sha256 = Sha256Hex(FileBytes(file).bytes());
  options.measurement.Select(&measurement);
  return measurement;
}

// The options, with those of the document whose fit is repeated where none were given.
FitFileOptions Resolved(const FitFileOptions& given) {
  FitFileOptions options = given;
  if (const std::optional<RecipeUsed> used = options.recipe.UsedByDocument()) {
    options.measurement.FillFrom(used->reading, options.recipe.name());
    options.fit.seed = used->seed;
    options.fit.starts = used->starts;
    if (!options.starts) options.fit.scouting_steps = used->scouting_steps;
  }
  options.fit.starts = options.starts.value_or(options.fit.starts);
  options.fit.seed = options.seed.value_or(options.fit.seed);
  return options;
}

}  // namespace

bool IsOneMaterial(const std::vector<std::string>& files) {
  return files.size() == 1 && LooksLikeMaterial(ParseFileSpec(files[0]).path);
}

void FitFileOptions::AddTo(CLI::App* app) {
  app->add_option("--starts", starts,
                  "descents from the best-ranked starts (default 8; five times as many for several lobes)")
      ->check(CLI::Range(1, 100000));
  app->add_option("--seed", seed, "seed of the subsample on which starts are ranked (default 1)");
  recipe.AddTo(app);
  measurement.AddTo(app);
}

FittedFile FitFile(const FitFileOptions& given, const std::vector<std::string>& files, int threads,
                   const std::string& command) {
  const auto start = std::chrono::steady_clock::now();
  const FitFileOptions options = Resolved(given);
  FittedFile fitted;
  const bool of_material = IsOneMaterial(files);
  fitted.measurement = of_material ? Sampled(options, files[0]) : options.measurement.LoadStated(files);
  const double read_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  FitOptions fit = options.fit;
  fit.threads = threads;
  Recipe recipe = options.recipe.Choose(fitted.measurement);
  RemarkFreeScale(recipe, &fitted.measurement);
  if (of_material && !recipe.sel) {
    throw UsageError(fmt::format(
        "{}: is a material, to which only lobes can be fitted; add --recipe sel, or give a measurement file",
        Excerpt(files[0], 200)));
  }
  std::vector<TriedModel> tried;
  if (options.recipe.IsAutomatic()) {
    const Recipe through = ThroughInstrument(recipe, fitted.measurement);
    LadderChoice choice = ClimbLadder(WithoutLastDescent(through), fit, &fitted.measurement);
    recipe = std::move(choice.recipe);
    // A number of descents that the user asked for is kept.
    if (choice.warm && !options.starts) {
      fit.scouting_steps = kScoutingSteps;
      fit.starts = kWarmStarts;
    }
    recipe.instrument = through.instrument;
    tried = std::move(choice.tried);
  }
  // What is fitted is what the document says, to the last bit of an angle.
  recipe = AsWritten(recipe);
  fitted.material = FitRecipe(recipe, fit, &fitted.measurement);
  if (options.recipe.IsAutomatic() && !options.recipe.overrides().HasFreeScale()) {
    if (const std::optional<Recipe> alternative = AutomaticAlternative(recipe, fitted.material))
      fitted.material = Fit(*alternative, fit, &fitted.measurement);
  }
  fitted.material.tried = std::move(tried);
  AddAdvice(&fitted.material);
  fitted.material.command = command;
  fitted.material.used->reading = options.measurement.Words();
  fitted.material.timings_s["read"] = read_s;
  return fitted;
}

std::string DoubtsAbout(const Material& material) {
  if (!material.termination.converged) {
    return fmt::format("the fit did not converge ({}); the document is marked; try more --starts or a simpler recipe",
                       material.termination.message);
  }
  if (!material.termination.determined) {
    return "the measurement does not determine every parameter; the document names them; try a simpler recipe";
  }
  if (material.verdict && material.verdict->kind == VerdictKind::kDoesNotDescribe) {
    return fmt::format(
        "the model does not describe the measurement: its typical error is {}; {}",
        PercentText(material.verdict->typical_error),
        material.verdict->advice.empty() ? "look at the values with `lobefit info`" : material.verdict->advice);
  }
  return "";
}

}  // namespace lobefit
