// lobefit VERB: the table of verbs, and what every error becomes.
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "text/help.h"
#include "verbs/verb.h"
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/base/process/threads.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/base/version.h"

namespace lobefit {
namespace {

struct Verb {
  const char* name;
  const char* description;
  const char* example;
  VerbSetup set_up;
};
constexpr Verb kVerbs[] = {
    {"info", "describe a measurement file", "lobefit info sample.csv", SetUpInfo},
    {"fit", "fit a reflectance model to a measurement file", "lobefit fit sample.csv --recipe ellipsoid", SetUpFit},
    {"batch", "fit many files, here or as shards on a cluster; goes on where it was",
     "lobefit batch measurements/ --out database", SetUpBatch},
    {"maps", "fit every texel of an image stack: maps of normals and reflectance with errors",
     "lobefit maps stack/ --leave-out 7", SetUpMaps},
    {"compare", "fit several recipes, judge them on held-out directions, recommend one",
     "lobefit compare sample.csv --recipes ggx,ggx-anisotropic,ellipsoid", SetUpCompare},
    {"report", "draw the report of a fitted material against its measurement again",
     "lobefit report sample.material.json sample.csv --out again.png", SetUpReport},
    {"convert", "write a measurement file in another format, and say what was lost",
     "lobefit convert sample.csv sample.binary --to merl", SetUpConvert},
    {"export", "write a fitted material for renderers, and say what each cannot carry",
     "lobefit export sample.material.json --to gltf,mitsuba", SetUpExport},
    {"synth", "make a synthetic measurement file from a material or recipe",
     "lobefit synth sample.material.json --theta-i 10,30,50 --noise 0.02 --out synthetic.csv", SetUpSynth},
    {"validate", "make measurements from known parameters, fit them, and check the intervals",
     "lobefit validate sample.material.json --noise 0.05 --trials 200", SetUpValidate},
    {"eval", "evaluate a quantity of the papers, with gradient, for rows of CSV", "lobefit eval --list", SetUpEval},
    {"formats", "list the file formats that are read, and the options of one", "lobefit formats csv", SetUpFormats},
};

// As a shell takes it.
std::string CommandLine(int argc, char** argv) {
  std::string command = "lobefit";
  for (int i = 1; i < argc; ++i) command += " " + ShellWord(argv[i]);
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
  CLI::App app("lobefit fits reflectance models to measured BRDF data.", "lobefit");
  SetUpHelp("lobefit VERB --help", &app);
  app.set_version_flag("--version", std::string("lobefit ") + Version());
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::help);
  CommonOptions common;
  common.command = CommandLine(argc, argv);
  common.words.assign(argv + std::min(argc, 1), argv + argc);
  std::function<int()> run;
  const CLI::App* asked = &app;
  for (const Verb& verb : kVerbs) {
    CLI::App* sub = app.add_subcommand(verb.name, verb.description);
    // Only the verb that was asked for sets up its options: the program starts in a few milliseconds.
    if (argc < 2 || std::string(argv[1]) != verb.name) continue;
    sub->add_option("--threads", common.threads, "number of threads (default: as many as the process may use)")
        ->check(CLI::Range(1, 1024));
    sub->add_flag("--json", common.json, "print the result as a JSON document on stdout");
    run = verb.set_up(sub, &common);
    SetUpHelp(verb.example, sub);
    asked = sub;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool help = error.get_exit_code() == 0;
    if (help) return app.exit(error);
    const std::string verb = argc > 1 && argv[1][0] != '-' ? std::string(" ") + argv[1] : "";
    const std::string unknown = UnknownWords(*asked);
    throw UsageError(fmt::format("{}; see `lobefit{} --help`", unknown.empty() ? error.what() : unknown, verb));
  }
  LimitThreads(common.threads);
  return run();
}

// A standard stream that is closed would be the number of the next file that is opened, and text for people would end
// up in a result: such a number is taken by a descriptor on which the stream's use fails.
void OccupyClosedStreams() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(number, F_GETFD) < 0) open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

// What a pipe was closed for, or a disk had no room for, is no success.
int CloseOutput(int exit_code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  std::fprintf(stderr, "lobefit: standard output cannot be written: %s; is the disk full, or the pipe closed?\n",
               std::strerror(errno));
  return exit_code == kExitDone || exit_code == kExitOther ? kExitInput : exit_code;
}

}  // namespace

int CommonOptions::Threads() const { return threads > 0 ? threads : HardwareThreads(); }

}  // namespace lobefit

int main(int argc, char** argv) {
  lobefit::OccupyClosedStreams();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) lobefit::RemoveTemporariesOnSignal(signal);
  std::string message;
  int exit_code = lobefit::kExitOther;
  try {
    exit_code = lobefit::Run(argc, argv);
  } catch (const lobefit::Error& error) {
    message = error.what();
    exit_code = error.exit_code();
  } catch (const std::bad_alloc&) {
    message = "out of memory; choose a part of the file with --theta-i or --channels, or fewer --threads";
  } catch (const std::exception& error) {
    // Printing throws where standard output fails, which CloseOutput tells.
    if (std::ferror(stdout) == 0) message = error.what();
  }
  if (!message.empty()) std::fprintf(stderr, "lobefit: %s\n", lobefit::Printable(message).c_str());
  return lobefit::CloseOutput(exit_code);
}
