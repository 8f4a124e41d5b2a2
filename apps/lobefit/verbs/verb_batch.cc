// lobefit batch: many files, on threads here or as shards anywhere; goes on where it was.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "options/report_formats.h"
#include "tasks/array_job.h"
#include "tasks/batch_progress.h"
#include "tasks/batch_tasks.h"
#include "text/output.h"
#include "verbs/verb.h"
#include <fmt/format.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/batch/collect.h"
#include "lobefit/batch/list/inputs.h"
#include "lobefit/batch/run/memory_limit.h"
#include "lobefit/batch/run/run.h"
#include "lobefit/batch/slurm.h"

namespace lobefit {
namespace {

struct BatchVerb {
  std::vector<std::string> inputs;
  std::string out, memory, reports = "none", format = "png,html", shard, engine;
  int jobs = 0;
  std::size_t shards = 0;
  bool retry_failed = false, dry_run = false, collect = false, status = false, submit = false;
  FitFileOptions fit;  // holds the words of the command line; each task has options of its own
  CLI::App* app = nullptr;
};

// Set by the first SIGTERM or SIGINT: what runs is finished and written down. The second one ends the program.
std::atomic<bool> stopped{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void OnStop(int signal) {
  stopped = true;
  RemoveTemporariesOnSignal(signal);
}

OptionWords CommonWords(const BatchVerb& verb) {
  OptionWords words;
  for (const std::string& name : FitOptionNames()) {
    const CLI::Option* option = verb.app->get_option_no_throw("--" + name);
    if (option != nullptr && option->count() > 0) words[name] = Join(option->results(), ",");
  }
  return words;
}

// The list that the command means: of its inputs, else the stored one.
WorkList ListOf(const BatchVerb& verb, TaskOptions* options) {
  const auto settings_of = [&](const OptionWords& words) { return options->SettingsOf(words); };
  const OptionWords common = CommonWords(verb);
  const WorkList stored = ReadWorkList(verb.out);
  if (verb.inputs.empty()) {
    WorkList list = stored;
    if (list.tasks.empty()) {
      throw UsageError(
          fmt::format("{}: holds no batch; name files, folders or a manifest to begin one", Excerpt(verb.out, 200)));
    }
    if (!common.empty()) {
      throw UsageError(
          fmt::format("--{}: without INPUT the stored options hold; name the inputs again and choose "
                      "another --out for other options",
                      common.begin()->first));
    }
    SetSettings(settings_of, &list);
    return list;
  }
  ManifestNames names;
  names.options = FitOptionNames();
  names.of_files = {"recipe"};
  names.refused = {"out", "name", "format", "no-report", "threads", "json"};
  names.reserved = ReservedColumns();
  Inputs inputs = GatherInputs(verb.inputs, common, names, verb.out, stored);
  if (inputs.skipped > 0) {
    std::fprintf(stderr, "lobefit: %zu file%s of the folders hold%s no measurement and %s left out: %s%s\n",
                 inputs.skipped, inputs.skipped == 1 ? "" : "s", inputs.skipped == 1 ? "s" : "",
                 inputs.skipped == 1 ? "is" : "are", Excerpt(Join(inputs.some_skipped), 400).c_str(),
                 inputs.skipped > inputs.some_skipped.size() ? ", ..." : "");
  }
  SetSettings(settings_of, &inputs.list);
  return std::move(inputs.list);
}

// Which of the ways to use the verb is meant, and that no option of another one is given.
void CheckOptions(const BatchVerb& verb) {
  const int ways = (verb.collect ? 1 : 0) + (verb.status ? 1 : 0) + (verb.engine.empty() ? 0 : 1) +
                   (verb.shard.empty() ? 0 : 1) + (verb.dry_run ? 1 : 0);
  const bool dry_shard = verb.dry_run && !verb.shard.empty() && ways == 2;
  if (ways > 1 && !dry_shard)
    throw UsageError("--collect, --status, --engine, --shard and --dry-run exclude each other; give one");
  if ((verb.collect || verb.status) && !verb.inputs.empty())
    throw UsageError("--collect and --status take the stored list; leave INPUT out");
  if (verb.engine.empty() && (verb.shards > 0 || verb.submit))
    throw UsageError("--shards and --submit belong to --engine slurm; a part alone is --shard I/N");
}

RunOptions RunOptionsOf(const BatchVerb& verb, const CommonOptions& common) {
  RunOptions options;
  options.limits.threads = common.Threads();
  options.limits.jobs = verb.jobs > 0 ? verb.jobs : options.limits.threads;
  options.limits.memory = verb.memory.empty() ? AvailableMemory() / 2 : ParseMemory(verb.memory);
  if (!verb.shard.empty()) options.shard = ParseShard(verb.shard);
  options.retry_failed = verb.retry_failed;
  return options;
}

int DryRun(const Plan& plan) {
  const auto print = [](const char* what, const std::vector<const Task*>& tasks) {
    for (const Task* task : tasks) fmt::print("{} {} ({} bytes)\n", what, Excerpt(task->id, 200), task->bytes);
  };
  print("fit", plan.usual);
  print("fit alone", plan.suspects);
  print("set aside as crashed", plan.crashed);
  fmt::print("{} listed, {} done, {} to do; nothing was written\n", plan.counts.listed, plan.counts.done_before,
             plan.counts.to_do);
  return kExitDone;
}

int PrintStatus(const BatchVerb& verb, const CommonOptions& common, const ResultTable& table) {
  if (common.json) {
    fmt::print("{}", StatusToJson(table));
  } else {
    Print(StatusToText(table));
  }
  const int code = table.ExitCode();
  if (code == kExitMissing && !common.json) {
    Print(fmt::format("Go on: lobefit batch --out {}\n", ShellWord(verb.out)));
  }
  return code;
}

// Writes the tables and the overview.
int CollectResults(const BatchVerb& verb, const CommonOptions& common) {
  const WorkList list = ReadWorkList(verb.out);
  if (list.tasks.empty())
    throw UsageError(fmt::format("{}: holds no batch, so that there is nothing to collect", Excerpt(verb.out, 200)));
  const Records records = ReadRecords(verb.out, common.Threads());
  const ResultTable table = MakeTable(list, records, common.Threads());
  if (verb.status) return PrintStatus(verb, common, table);
  WriteResults(table, common.Threads(), verb.out);
  if (!common.json) Print(fmt::format("Results: {}\n", PrintableName(std::filesystem::path(verb.out) / "index.html")));
  return PrintStatus(verb, common, table);
}

// A rough guess, by which shards get about a minute each: measured on one core of 2024.
double SecondsOf(const WorkList& list) {
  constexpr double kEach = 0.03, kByte = 2e-8;
  double seconds = 0;
  for (const Task& task : list.tasks) seconds += kEach + kByte * static_cast<double>(task.bytes);
  return seconds;
}

int WriteSlurm(const BatchVerb& verb, const CommonOptions& common, const WorkList& list) {
  const std::filesystem::path folder = std::filesystem::absolute(verb.out).lexically_normal();
  ArrayJob job;
  job.name = "lobefit";
  job.shards = verb.shards > 0 ? verb.shards : DefaultShards(list.tasks.size(), SecondsOf(list));
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  job.shard = {program, "batch", "--out", folder.string(), "--reports", verb.reports, "--format", verb.format};
  if (verb.jobs > 0) job.shard.insert(job.shard.end(), {"--jobs", std::to_string(verb.jobs)});
  if (!verb.memory.empty()) job.shard.insert(job.shard.end(), {"--memory", verb.memory});
  if (verb.retry_failed) job.shard.emplace_back("--retry-failed");
  job.collect = {program, "batch", "--out", folder.string(), "--collect"};
  job.folder = folder;
  job.threads = std::max(1, common.threads);
  return WriteOrSend(job, verb.submit);
}

int RunBatch(const BatchVerb& verb, const CommonOptions& common) {
  const RunOptions options = RunOptionsOf(verb, common);
  CheckOptions(verb);
  if (verb.collect || verb.status) return CollectResults(verb, common);
  TaskOptions task_options;
  const BatchReports reports = verb.reports == "all"      ? BatchReports::kAll
                               : verb.reports == "failed" ? BatchReports::kDoubtful
                                                          : BatchReports::kNone;
  const FitWork work(verb.out, reports, ParseReportFormats(verb.format), task_options);
  const WorkList list = ListOf(verb, &task_options);
  if (verb.shards > list.tasks.size()) {
    throw UsageError(fmt::format("--shards {}: there are only {} tasks; at most one shard a task is allowed",
                                 verb.shards, list.tasks.size()));
  }
  if (!verb.dry_run) StoreWorkList(list, verb.out);
  if (!verb.engine.empty()) return WriteSlurm(verb, common, list);
  const Records records = ReadRecords(verb.out, common.Threads());
  const Plan plan = MakePlan(list, records, options, verb.out);
  if (verb.dry_run) return DryRun(plan);
  std::signal(SIGTERM, OnStop);
  std::signal(SIGINT, OnStop);
  {
    BatchProgress progress(plan.counts.to_do, isatty(STDOUT_FILENO) == 0 && !common.json);
    RunPlan(plan, options, verb.out, stopped, work, [&](const DoneRecord& done) { progress.Add(done); });
  }
  if (stopped) std::fprintf(stderr, "lobefit: stopped; the same command goes on\n");
  if (options.shard.IsWhole()) return CollectResults(verb, common);
  return stopped ? kExitMissing : kExitDone;
}

}  // namespace

std::function<int()> SetUpBatch(CLI::App* app, CommonOptions* common) {
  auto verb = std::make_shared<BatchVerb>();
  verb->app = app;
  app->add_option("INPUT", verb->inputs,
                  "files, folders (searched for measurements), a manifest (CSV with a column file; options of fit as "
                  "further columns), - for names on stdin; without any, the batch that OUT holds goes on. Where "
                  "several files are one measurement, a manifest's row names their folder, a pattern as scan_*.csv, or "
                  "a list with ; between");
  app->add_option("--out", verb->out, "folder of the batch")->required();
  app->add_option("--jobs", verb->jobs, "fits at once (default: as many as threads)")->check(CLI::Range(1, 1024));
  app->add_option("--memory", verb->memory,
                  "memory for all fits together, as 500M or 4G (default: half of the machine)");
  app->add_option("--reports", verb->reports, "reports to draw, each costs ten fits: none (default), failed, all")
      ->check(CLI::IsMember({"none", "failed", "all"}));
  app->add_option("--format", verb->format, "formats of the reports, with commas between (default png,html)");
  app->add_flag("--retry-failed", verb->retry_failed, "do again what failed or crashed");
  app->add_flag("--dry-run", verb->dry_run, "say what would be done, and write nothing");
  app->add_option("--shard", verb->shard, "I/N: do the I-th of N parts, and do not collect");
  app->add_flag("--collect", verb->collect,
                "write results.csv, runs.csv, results.jsonl and index.html of what is done");
  app->add_flag("--status", verb->status, "say what is done, failed and missing");
  app->add_option("--engine", verb->engine, "slurm: write OUT/array.sbatch in place of fitting")
      ->check(CLI::IsMember({"slurm"}));
  app->add_option("--shards", verb->shards, "parts for the engine (default: about a minute each)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{100000}));
  app->add_flag("--submit", verb->submit, "send the script to the engine at once");
  verb->fit.AddTo(app);
  return [=] { return RunBatch(*verb, *common); };
}

}  // namespace lobefit
