// lobefit fit: a measurement file becomes NAME.material.json, NAME.report.png and NAME.report.html.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "options/report_formats.h"
#include "tasks/fit_file.h"
#include "text/output.h"
#include "text/summary.h"
#include "text/terminal_plot.h"
#include "verbs/verb.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/process/progress.h"
#include "lobefit/fit/ladder.h"
#include "lobefit/io/series.h"
#include "lobefit/material/json.h"
#include "lobefit/report/report.h"

namespace lobefit {
namespace {

struct FitVerb {
  FitFileOptions options;
  std::vector<std::string> files;
  std::string out = ".", name, format = "png,html";
  bool no_report = false;
};

int RunFit(const FitVerb& verb, const CommonOptions& common) {
  const std::string stem = SeriesName(verb.files);
  const bool of_material = IsOneMaterial(verb.files);
  // A table of lobes must not overwrite the material that it was sampled from.
  const std::string own = of_material ? stem.substr(0, stem.find('.')) + ".sel" : stem;
  const std::string name = ResultName(verb.name, own);
  const std::filesystem::path folder = verb.out;
  const std::vector<std::string> formats = ParseReportFormats(verb.format);
  MakeFolder(folder);
  const std::filesystem::path document = folder / (name + ".material.json"), picture = folder / (name + ".report.png");
  const std::vector<std::filesystem::path> inputs = InputPaths(verb.files);
  CheckOutput(document, inputs);
  if (!verb.no_report) CheckReports(formats, picture, inputs);

  FitFileOptions options = verb.options;
  std::optional<Progress> progress(std::in_place, "models", kMostTried);
  options.fit.on_tried = [&progress] { progress->Advance(); };
  FittedFile fitted = FitFile(options, verb.files, common.Threads(), common.command);
  progress.reset();
  Material& material = fitted.material;

  // The document first: it is kept even where drawing fails.
  WriteMaterial(material, document);
  std::string pictures;
  if (!verb.no_report) {
    const auto start = std::chrono::steady_clock::now();
    ReportOptions report;
    report.threads = common.Threads();
    pictures = WriteReports(formats, material, fitted.measurement, picture, report);
    material.timings_s["report"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    WriteMaterial(material, document);
  }
  if (common.json) {
    fmt::print("{}", ToJson(material));
  } else {
    Print(Summary(material) + WorstSlicePlot(material, fitted.measurement, TerminalColumns()));
    Print(fmt::format("Result:  {}\n", PrintableName(document)) + pictures);
  }
  // The result as it is handed over: exit code 4 says that it is not to be trusted.
  const std::string doubts = DoubtsAbout(material);
  if (doubts.empty()) return kExitDone;
  Print(fmt::format("lobefit: {}\n", doubts), stderr);
  return kExitFit;
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
  verb->options.AddTo(app);
  return [=] { return RunFit(*verb, *common); };
}

}  // namespace lobefit
