#include "tasks/trial_parts.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "tasks/array_job.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/validate/trial_store.h"

namespace lobefit {
namespace {

// The command line without what is said anew for each part.
std::vector<std::string> WordsOf(const CommonOptions& common) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < common.words.size(); ++i) {
    const std::string& word = common.words[i];
    const bool with_value = word == "--engine" || word == "--shards" || word == "--threads";
    const bool joined =
        word.starts_with("--engine=") || word.starts_with("--shards=") || word.starts_with("--threads=");
    if (with_value) ++i;
    if (!with_value && !joined && word != "--submit") words.push_back(word);
  }
  return words;
}

}  // namespace

void TrialParts::AddTo(CLI::App* app) {
  const std::string group = "Many trials";
  app->add_option("--out", out_, "keep the trials in this folder: the same command goes on after a kill")->group(group);
  app->add_option("--shard", shard_, "I/N: run the I-th of N parts of the trials into OUT, and report nothing")
      ->group(group);
  app->add_flag("--collect", collect_, "report on the trials that OUT holds, and run none")->group(group);
  app->add_option("--engine", engine_, "slurm: write OUT/array.sbatch in place of running")
      ->check(CLI::IsMember({"slurm"}))
      ->group(group);
  app->add_option("--shards", shards_, "parts for the engine (default: one for 200 trials)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{100000}))
      ->group(group);
  app->add_flag("--submit", submit_, "send the script to the engine at once")->group(group);
}

void TrialParts::Check(bool elsewhere) const {
  const int ways = (collect_ ? 1 : 0) + (engine_.empty() ? 0 : 1) + (shard_.empty() ? 0 : 1);
  if (ways > 1) throw UsageError("--collect, --engine and --shard exclude each other; give one");
  if (ways > 0 && out_.empty())
    throw UsageError("--collect, --engine and --shard need --out, where the trials are kept");
  if (engine_.empty() && (shards_ > 0 || submit_))
    throw UsageError("--shards and --submit belong to --engine slurm; a part alone is --shard I/N");
  if (elsewhere && !out_.empty())
    throw UsageError("--out keeps the trials of one experiment: leave it out with --sweep or a file");
  if (!shard_.empty()) ParseShard(shard_);
}

std::size_t TrialParts::Count(std::size_t trials) const {
  if (collect_) return 0;
  const Shard shard = shard_.empty() ? Shard{} : ParseShard(shard_);
  return (trials + shard.count - shard.index) / shard.count;
}

std::vector<Trial> TrialParts::Run(const Experiment& experiment, std::size_t trials, const std::string& folder,
                                   int threads, Progress* progress, const std::atomic<bool>& stop) const {
  std::optional<TrialStore> store;
  std::vector<Trial> all(trials);
  if (!out_.empty()) {
    store.emplace(std::filesystem::path(out_) / folder, KeyOf(experiment));
    all = store->Read(trials);
  }
  if (collect_) return all;
  const Shard shard = shard_.empty() ? Shard{} : ParseShard(shard_);
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < trials; ++i) {
    if (!shard.Holds(i)) continue;
    if (all[i].done) {
      progress->Advance();
    } else {
      missing.push_back(i);
    }
  }
  const auto done = [&](std::size_t index, Trial trial) {
    if (store) store->Append(index, trial);
    all[index] = std::move(trial);
    progress->Advance();
  };
  RunTrials(experiment, missing, threads, done, stop);
  if (store) store->Close();
  return all;
}

int TrialParts::WriteScript(std::size_t trials, const CommonOptions& common) const {
  constexpr std::size_t kTrialsOfAShard = 200;
  const std::filesystem::path folder = std::filesystem::absolute(out_).lexically_normal();
  ArrayJob job;
  job.name = "lobefit-validate";
  job.shards = shards_ > 0 ? shards_ : std::clamp<std::size_t>(trials / kTrialsOfAShard, 1, 1000);
  if (job.shards > trials)
    throw UsageError(
        fmt::format("--shards {}: there are only {} trials; at most one part a trial is allowed", job.shards, trials));
  // The command may name files by where it was given.
  job.shard = {"env", "-C", std::filesystem::current_path().string(),
               std::filesystem::read_symlink("/proc/self/exe").string()};
  const std::vector<std::string> words = WordsOf(common);
  job.shard.insert(job.shard.end(), words.begin(), words.end());
  job.collect = job.shard;
  job.collect.emplace_back("--collect");
  job.folder = folder;
  job.threads = std::max(1, common.threads);
  return WriteOrSend(job, submit_);
}

}  // namespace lobefit
