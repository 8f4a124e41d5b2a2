// Trials of one validation that any number of processes run, kept in a folder: each process appends to a file of its
// own (Journal), one line a trial, so that a kill loses the trials that ran and nothing else.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/batch/run/journal.h"
#include "lobefit/validate/experiment.h"

namespace lobefit {

// SHA-256 of all that a trial depends on: truth, directions, noise, recipe, options of the fit, seed, version.
std::string KeyOf(const Experiment& experiment);

class TrialStore {
 public:
  // Makes the folder. `key` as above.
  TrialStore(const std::filesystem::path& folder, std::string key);

  // Trials [0, count); those that the folder does not hold come back as not done. Lines that were cut short by a death
  // are passed over. Throws UsageError where the folder holds trials of another validation.
  std::vector<Trial> Read(std::size_t count) const;
  // From any thread; outlives this process at once, and is on the disk a moment later. Throws OutputError.
  void Append(std::size_t index, const Trial& trial);
  // Brings all to the disk. Throws OutputError. Nothing may be appended after it.
  void Close();

 private:
  std::filesystem::path folder_;
  std::string key_;
  Journal journal_;
};

// One line without its end; NaN as null. The reader throws an exception for a line that is not whole.
std::string ToLine(const std::string& key, std::size_t index, const Trial& trial);

}  // namespace lobefit
