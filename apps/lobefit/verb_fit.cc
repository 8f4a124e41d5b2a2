// lobefit fit: a measurement file becomes NAME.material.json, NAME.report.png and NAME.report.html.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "measurement_options.h"
#include "recipe_options.h"
#include "report_formats.h"
#include "summary.h"
#include "terminal_plot.h"
#include "verb.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/base/text.h"
#include "lobefit/fit/fit.h"
#include "lobefit/fit/ladder.h"
#include "lobefit/fit/sel/sampling.h"
#include "lobefit/io/series.h"
#include "lobefit/material/json.h"
#include "lobefit/report/report.h"

namespace lobefit {
namespace {

struct FitVerb {
  MeasurementOptions measurement;
  RecipeOptions recipe;
  FitOptions fit;
  std::vector<std::string> files;
  std::string out = ".", name, format = "png,html";
  bool no_report = false;
};

double Seconds(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The result as it is handed over: exit code 4 says that it is not to be trusted.
int Judge(const Material& material) {
  if (!material.termination.converged) {
    std::fprintf(
        stderr,
        "lobefit: the fit did not converge (%s); the document is marked; try more --starts or a simpler recipe\n",
        material.termination.message.c_str());
    return kExitFit;
  }
  if (!material.termination.determined) {
    std::fprintf(
        stderr,
        "lobefit: the measurement does not determine every parameter; the document names them; try a simpler recipe\n");
    return kExitFit;
  }
  if (material.verdict && material.verdict->kind == VerdictKind::kDoesNotDescribe) {
    std::fprintf(
        stderr, "lobefit: the model does not describe the measurement: its typical error is %s; %s\n",
        PercentText(material.verdict->typical_error).c_str(),
        material.verdict->advice.empty() ? "look at the values with `lobefit info`" : material.verdict->advice.c_str());
    return kExitFit;
  }
  return kExitDone;
}

// What a material gives on hemispheres, in place of a measurement.
Measurement Sampled(const FitVerb& verb) {
  Measurement measurement = SampleForSel(ReadModelMaterial(verb.files[0]));
  measurement.source = std::filesystem::path(verb.files[0]).filename().string();
  measurement.sha256 = Sha256Hex(FileBytes(verb.files[0]).bytes());
  verb.measurement.Select(&measurement);
  return measurement;
}

int RunFit(const FitVerb& verb, const CommonOptions& common) {
  const std::filesystem::path folder = verb.out;
  MakeFolder(folder);

  auto start = std::chrono::steady_clock::now();
  const bool of_model = verb.files.size() == 1 && LooksLikeMaterial(ParseFileSpec(verb.files[0]).path);
  Measurement measurement = of_model ? Sampled(verb) : verb.measurement.LoadStated(verb.files);
  const double read_s = Seconds(start);
  FitOptions options = verb.fit;
  options.threads = common.Threads();
  verb.recipe.overrides().Remark(&measurement);
  Recipe recipe = verb.recipe.Choose(measurement);
  if (of_model && !recipe.sel) {
    throw UsageError(fmt::format(
        "{}: is a material, to which only lobes can be fitted; add --recipe sel, or give a measurement file",
        Excerpt(verb.files[0], 200)));
  }
  std::vector<TriedModel> tried;
  if (verb.recipe.IsAutomatic()) {
    LadderChoice choice = ClimbLadder(recipe, options, &measurement);
    recipe = choice.recipe;
    tried = std::move(choice.tried);
  }
  Material material = FitRecipe(recipe, options, &measurement);
  if (verb.recipe.IsAutomatic() && !verb.recipe.overrides().HasFreeScale()) {
    if (const std::optional<Recipe> alternative = AutomaticAlternative(recipe, material))
      material = Fit(*alternative, options, &measurement);
  }
  material.tried = std::move(tried);
  AddAdvice(&material);
  material.command = common.command;
  material.timings_s["read"] = read_s;

  // A table of lobes must not overwrite the material that it was sampled from.
  const std::string stem = SeriesName(verb.files);
  const std::string name = !verb.name.empty() ? verb.name : of_model ? stem.substr(0, stem.find('.')) + ".sel" : stem;
  const std::filesystem::path document = folder / (name + ".material.json"), picture = folder / (name + ".report.png");
  const std::vector<std::string> formats = ParseReportFormats(verb.format);
  // The document first: it is kept even where drawing fails.
  WriteMaterial(material, document);
  std::string pictures;
  if (!verb.no_report) {
    start = std::chrono::steady_clock::now();
    ReportOptions report;
    report.threads = options.threads;
    pictures = WriteReports(formats, material, measurement, picture, report);
    material.timings_s["report"] = Seconds(start);
    WriteMaterial(material, document);
  }
  if (common.json) {
    fmt::print("{}", ToJson(material));
  } else {
    fmt::print("{}{}", Summary(material), WorstSlicePlot(material, measurement, TerminalColumns()));
    fmt::print("Result:  {}\n", document.string());
    fmt::print("{}", pictures);
  }
  return Judge(material);
}

}  // namespace

std::function<int()> SetUpFit(CLI::App* app, CommonOptions* common) {
  auto verb = std::make_shared<FitVerb>();
  app->add_option(
         "FILE", verb->files,
         "measurement files: one, or several and folders as one measurement; FILE:theta_i=30 states what a file "
         "lacks; for recipe sel also a *.material.json")
      ->required();
  app->add_option("--out", verb->out, "folder of the results (default: the current one)");
  app->add_option("--name", verb->name, "NAME of the results (default: the file's name without its ending)");
  app->add_option("--format", verb->format,
                  "formats of the report, with commas between: png, html, exr (the maps behind the pictures); default "
                  "png,html");
  app->add_flag("--no-report", verb->no_report, "write no picture and no page");
  app->add_option("--starts", verb->fit.starts,
                  "descents from the best-ranked starts (default 8; five times as many for several lobes)")
      ->check(CLI::Range(1, 100000));
  app->add_option("--seed", verb->fit.seed, "seed of the subsample on which starts are ranked (default 1)");
  verb->recipe.AddTo(app);
  verb->measurement.AddTo(app);
  return [=] { return RunFit(*verb, *common); };
}

}  // namespace lobefit
