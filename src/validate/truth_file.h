// The truth that a synthetic measurement file carries: in its comments, or beside it as FILE.truth.json. Fits ignore
// it; validation compares with it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/synthesis/synthesis.h"
#include "lobefit/validate/truth.h"

namespace lobefit {

struct TruthRecord {
  Truth truth;
  Noise noise;
  std::uint64_t seed = 1;
  std::string command;  // that made the file
};

// Lines for people, then one line "lobefit.truth: {...}" with the document; without comment signs.
std::vector<std::string> TruthComments(const TruthRecord& record);

// Writes `measurement_path`.truth.json and returns its path. Throws OutputError.
std::filesystem::path WriteTruthBeside(const TruthRecord& record, const std::filesystem::path& measurement_path);

// The truth in a file's first MiB, else beside it; nothing where there is none. Throws InputError for one that is
// damaged.
std::optional<TruthRecord> FindTruth(const std::filesystem::path& measurement_path);

}  // namespace lobefit
