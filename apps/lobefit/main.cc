// lobefit VERB: the table of verbs, and what every error becomes.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>

#include "verb.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/parallel.h"
#include "lobefit/base/text.h"
#include "lobefit/base/version.h"

namespace lobefit {
namespace {

struct Verb {
  const char* name;
  const char* description;
  VerbSetup set_up;
};
constexpr Verb kVerbs[] = {
    {"info", "describe a measurement file", SetUpInfo},
    {"fit", "fit a reflectance model to a measurement file", SetUpFit},
    {"compare", "fit several recipes, judge them on held-out directions, recommend one", SetUpCompare},
    {"report", "draw the report of a fitted material against its measurement again", SetUpReport},
    {"convert", "write a measurement file in another format, and say what was lost", SetUpConvert},
    {"export", "write a fitted material for renderers, and say what each cannot carry", SetUpExport},
    {"synth", "make a synthetic measurement file from a material or recipe", SetUpSynth},
    {"validate", "make measurements from known parameters, fit them, and check the intervals", SetUpValidate},
    {"eval", "evaluate a quantity of the papers, with gradient, for rows of CSV", SetUpEval},
};

std::string CommandLine(int argc, char** argv) {
  std::string command = "lobefit";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool plain = argument.find_first_of(" \t\"'$\\*?") == std::string::npos && !argument.empty();
    command += plain ? " " + argument : " '" + argument + "'";
  }
  return command;
}

// A first argument that is no verb gets the list of verbs instead of a parser's message.
void CheckVerb(int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> names;
  for (const Verb& verb : kVerbs) names.emplace_back(verb.name);
  const std::string given = argv[1];
  if (std::find(names.begin(), names.end(), given) != names.end()) return;
  throw UsageError(
      fmt::format("'{}' is not a verb{}; the verbs are: {}", Excerpt(given), DidYouMean(given, names), Join(names)));
}

int Run(int argc, char** argv) {
  CheckVerb(argc, argv);
  CLI::App app("lobefit fits reflectance models to measured BRDF data.");
  app.set_version_flag("--version", std::string("lobefit ") + Version());
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::help);
  CommonOptions common;
  common.command = CommandLine(argc, argv);
  std::function<int()> run;
  for (const Verb& verb : kVerbs) {
    CLI::App* sub = app.add_subcommand(verb.name, verb.description);
    // Only the verb that was asked for sets up its options: the program starts in a few milliseconds.
    if (argc < 2 || std::string(argv[1]) != verb.name) continue;
    sub->add_option("--threads", common.threads, "number of threads (default: as many as the process may use)")
        ->check(CLI::Range(1, 1024));
    sub->add_flag("--json", common.json, "print the result as a JSON document on stdout");
    run = verb.set_up(sub, &common);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool help = error.get_exit_code() == 0;
    if (help) return app.exit(error);
    const std::string verb = argc > 1 && argv[1][0] != '-' ? std::string(" ") + argv[1] : "";
    throw UsageError(fmt::format("{}; see `lobefit{} --help`", error.what(), verb));
  }
  return run();
}

}  // namespace

int CommonOptions::Threads() const { return threads > 0 ? threads : HardwareThreads(); }

}  // namespace lobefit

int main(int argc, char** argv) {
  try {
    return lobefit::Run(argc, argv);
  } catch (const lobefit::Error& error) {
    std::fprintf(stderr, "lobefit: %s\n", error.what());
    return error.exit_code();
  } catch (const std::bad_alloc&) {
    std::fputs("lobefit: out of memory; choose a part of the file with --theta-i, or fewer --threads\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lobefit: %s\n", error.what());
  }
  return lobefit::kExitOther;
}
