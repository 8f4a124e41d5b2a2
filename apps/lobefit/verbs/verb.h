// A verb of the program: its name, one line for the help, and how it adds its options and runs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace lobefit {

// Options that every verb has.
struct CommonOptions {
  int threads = 0;  // 0: as many as the process may use
  bool json = false;
  std::string command;             // the whole command line, for the record in results
  std::vector<std::string> words;  // the same after the program's name

  int Threads() const;
};

// Adds options to `app` and returns what runs the verb; the result is the exit code.
using VerbSetup = std::function<int()> (*)(CLI::App* app, CommonOptions* common);

std::function<int()> SetUpBatch(CLI::App* app, CommonOptions* common);
std::function<int()> SetUpEval(CLI::App* app, CommonOptions* common);
std::function<int()> SetUpCompare(CLI::App* app, CommonOptions* common);
std::function<int()> SetUpConvert(CLI::App* app, CommonOptions* common);
std::function<int()> SetUpExport(CLI::App* app, CommonOptions* common);
std::function<int()> SetUpFit(CLI::App* app, CommonOptions* common);
std::function<int()> SetUpFormats(CLI::App* app, CommonOptions* common);
std::function<int()> SetUpInfo(CLI::App* app, CommonOptions* common);
std::function<int()> SetUpMaps(CLI::App* app, CommonOptions* common);
std::function<int()> SetUpReport(CLI::App* app, CommonOptions* common);
std::function<int()> SetUpSynth(CLI::App* app, CommonOptions* common);
std::function<int()> SetUpValidate(CLI::App* app, CommonOptions* common);

}  // namespace lobefit
