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
  std::string map_path;          // folder before the names of normal maps in the files, "materials/" or ""
  bool old_mitsuba = false;      // for Mitsuba 3.0 to 3.7.0
  Numbers numbers = Numbers::kBetter;
  int threads = 1;
};

struct ExportResult {
  const Target* target = nullptr;
  std::vector<std::filesystem::path> files;
  std::uintmax_t bytes = 0;
  std::vector<Carried> carries;
  std::string numbers;               // "exact", "tabulated", "copied" or "refitted"
  std::string choice;                // in words, why these; "" where there was none
  ExportError error;                 // of what was written
  std::optional<ExportError> other;  // of the numbers that were not taken, where both were tried
  std::string load;                  // how to load it, with the names of this material
  std::vector<std::string> notes;
  double seconds = 0;
};

// A target that cannot hold the material, and why.
struct Refusal {
  const Target* target = nullptr;
  std::string reason;
};

struct ExportOutcome {
  std::vector<ExportResult> results;
  std::vector<Refusal> refusals;
  std::vector<std::string> remarks;  // of the material whatever the target
};

// Writes the files of every target that can hold the material and NAME.export.json, which holds the table (rows of
// other targets that an earlier export of the same material left there are kept). Tilts and turns that the fit did not
// determine are left out (OnlyDetermined) but of the document itself; a fit of other channels is converted for targets
// of R, G, B. Throws InputError, before anything is written, where no target can hold the material: with the reasons
// and the targets that can. Throws OutputError.
ExportOutcome ExportMaterial(const Material& material, const ExportOptions& options);

// How to load a target's files of a material of this name.
std::string LoadText(const Target& target, const std::string& name);
// The table and the notes, for people; of refusals one line for each reason.
std::string ExportSummary(const ExportOutcome& outcome);
std::string RefusalText(const std::vector<Refusal>& refusals);
// Figures of an error with what they are of, one line.
std::string ErrorWords(const ExportError& error);

// Adds to the head of a document what the target does not carry exactly; a control character of any line, which could
// end a comment, becomes a blank.
void AddLosses(const std::vector<Carried>& carries, std::vector<std::string>* head);
// What was exported, for its record.
struct ExportSource {
  std::string kind;    // "material" or "maps"
  std::string sha256;  // of it
  std::string source;  // what it was fitted to
};
// As NAME.export.json.
std::string ExportJson(const ExportSource& source, const ExportOptions& options, const ExportOutcome& outcome);
std::string ExportJson(const Material& material, const ExportOptions& options, const ExportOutcome& outcome);

}  // namespace lobefit
