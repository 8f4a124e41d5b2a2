// Export of a fitted material to the files of renderers, with a table of what each target carries and how far its
// model is from the fit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/export/targets/error_meter.h"
#include "lobefit/export/targets/target.h"
#include "lobefit/material/material.h"

namespace lobefit {

// Where a target's own model differs from the fit's: the fit's numbers translated, the target's model fitted to the
// fit's values, or whichever of the two has the smaller error.
enum class Numbers { kBetter, kCopied, kRefitted };

struct ExportOptions {
  std::vector<const Target*> targets;
  std::filesystem::path folder;  // made where it does not exist
  std::string name;              // of the material; files are NAME and an ending
  std::string material_file;     // for the comments
  std::string command;           // likewise
  Numbers numbers = Numbers::kBetter;
  int threads = 1;
};

struct ExportResult {
  const Target* target = nullptr;
  std::vector<std::filesystem::path> files;
  std::uintmax_t bytes = 0;
  std::vector<Carried> carries;
  std::string numbers;               // "exact", "tabulated", "copied" or "refitted"
  ExportError error;                 // of what was written
  std::optional<ExportError> other;  // of the numbers that were not taken, where both were tried
  std::vector<std::string> notes;
  double seconds = 0;
};

// Writes the files of every target and NAME.export.json, which holds the table (rows of other targets that an earlier
// export of the same material left there are kept). Throws InputError, before anything is written, where a target
// cannot hold the material at all: with the reason and the targets that can. Throws OutputError.
std::vector<ExportResult> ExportMaterial(const Material& material, const ExportOptions& options);

// The table and the notes, for people.
std::string ExportSummary(const std::vector<ExportResult>& results);
// As NAME.export.json.
std::string ExportJson(const Material& material, const ExportOptions& options,
                       const std::vector<ExportResult>& results);

}  // namespace lobefit
