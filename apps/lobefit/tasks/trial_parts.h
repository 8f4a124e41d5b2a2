// Trials of a validation kept in a folder: gone on with after a kill, or run in parts anywhere and collected.
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <vector>

#include "verbs/verb.h"

#include "lobefit/base/process/progress.h"
#include "lobefit/batch/list/shard.h"
#include "lobefit/validate/experiment.h"

namespace lobefit {

class TrialParts {
 public:
  // --out, --shard, --collect, --engine, --shards, --submit.
  void AddTo(CLI::App* app);
  // Throws UsageError where options do not go together; `elsewhere`: what is validated has no trials that can be kept.
  void Check(bool elsewhere) const;

  bool is_script() const { return !engine_.empty(); }
  // This process runs a part and leaves the result to another one.
  bool is_part() const { return !shard_.empty(); }
  // How many of `trials` are this process'.
  std::size_t Count(std::size_t trials) const;

  // Runs the trials that are this process' and that OUT/`folder` does not hold yet. Returns all that are there, the
  // others as not done.
  std::vector<Trial> Run(const Experiment& experiment, std::size_t trials, const std::string& folder, int threads,
                         Progress* progress, const std::atomic<bool>& stop) const;
  // Writes OUT/array.sbatch for the same command line in parts, and sends it where asked.
  int WriteScript(std::size_t trials, const CommonOptions& common) const;

 private:
  std::string out_, shard_, engine_;
  bool collect_ = false, submit_ = false;
  std::size_t shards_ = 0;
};

}  // namespace lobefit
