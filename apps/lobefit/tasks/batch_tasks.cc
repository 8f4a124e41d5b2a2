#include "tasks/batch_tasks.h"

#include <utility>

#include "options/report_formats.h"

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/base64.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/version.h"
#include "lobefit/batch/results/result_row.h"
#include "lobefit/batch/results/sphere_picture.h"
#include "lobefit/material/json.h"

namespace lobefit {
namespace {

// The command that fits one task alone.
std::string CommandOf(const Task& task) {
  std::string command = "lobefit fit";
  for (const std::string& file : task.members.empty() ? std::vector<std::string>{task.file} : task.members)
    command += " " + ShellWord(file);
  for (const auto& [name, word] : task.options) command += " --" + name + " " + ShellWord(word);
  return command;
}

}  // namespace

std::vector<std::string> FitOptionNames() {
  CLI::App app;
  FitFileOptions options;
  options.AddTo(&app);
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      if (name != "help") names.push_back(name);
    }
  }
  return names;
}

std::string TaskOptions::SettingsOf(const OptionWords& words) {
  auto options = std::make_shared<FitFileOptions>();
  CLI::App app;
  options->AddTo(&app);
  // The parser takes them from the end.
  std::vector<std::string> arguments;
  std::string text = std::string("lobefit ") + Version() + "\n";
  for (const auto& [name, word] : words) {
    arguments.insert(arguments.begin(), "--" + name + "=" + word);
    if (name != "recipe") text += "--" + name + "=" + word + "\n";
  }
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
  options->measurement.Check();
  // The digest speaks for the text that is fitted by.
  options->recipe.Keep();
  text += options->recipe.Resolved();
  options_.emplace(words, std::move(options));
  return Sha256Hex(text);
}

FitWork::FitWork(std::filesystem::path out, BatchReports reports, std::vector<std::string> formats,
                 const TaskOptions& options)
    : out_(std::move(out)), reports_(reports), formats_(std::move(formats)), options_(options) {}

Outcome FitWork::operator()(const Task& task, int threads) const {
  FittedFile fitted = FitFile(options_.Of(task), FilesToFit(task), threads, CommandOf(task));
  const std::string doubts = DoubtsAbout(fitted.material);
  const std::filesystem::path document = ResultPath(out_, task.id, ".material.json");
  MakeFolder(document.parent_path());
  if (reports_ == BatchReports::kAll || (reports_ == BatchReports::kDoubtful && !doubts.empty())) {
    ReportOptions report;
    report.threads = threads;
    WriteReports(formats_, fitted.material, fitted.measurement, ResultPath(out_, task.id, ".report.png"), report);
  }
  const SpherePicture picture = DrawSpheres(fitted.material, fitted.measurement);
  FileGroup files;
  const std::string json = ToJson(fitted.material);
  files.Add(document, json);
  return {doubts.empty() ? TaskStatus::kFitted : TaskStatus::kDoubtful,
          doubts.empty() ? kExitDone : kExitFit,
          doubts,
          ResultRow(fitted.material),
          json.size(),
          fitted.measurement.sha256,
          std::move(files),
          Base64(picture.png),
          picture.measured};
}

}  // namespace lobefit
