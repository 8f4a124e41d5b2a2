// The words by which users and file headers choose what a file leaves open.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/io/text/format.h"

namespace lobefit {

// Case does not matter; nothing for a word that is not known.
std::optional<ValueKind> ParseValueKind(std::string_view word);          // see AllowedValueKinds()
std::optional<IncidentSense> ParseIncidentSense(std::string_view word);  // towards, propagation
std::optional<RepeatedRows> ParseRepeatedRows(std::string_view word);    // first, mean
std::optional<CellPosition> ParseCellPosition(std::string_view word);    // centre, center, edge
std::optional<UtiaEncoding> ParseUtiaEncoding(std::string_view word);    // raw, srgb
std::optional<ExrAxes> ParseExrAxes(std::string_view word);              // slice, slice-sqrt, hemisphere, utia
std::optional<ExrProjection> ParseExrProjection(std::string_view word);  // equidistant, equal-area, concentric
std::optional<ExrRows> ParseExrRows(std::string_view word);              // up, down
std::string AllowedValueKinds();

std::string Name(AngleUnit unit);
std::string Name(ValueKind kind);
std::string Name(IncidentSense sense);
std::string Name(RepeatedRows rows);
std::string Name(CellPosition position);
std::string Name(UtiaEncoding encoding);
std::string Name(ExrAxes axes);
std::string Name(ExrProjection projection);
std::string Name(ExrRows rows);

// Every option of ReadOptions as the command line has it, for one loop there instead of one branch an option. `set`
// throws UsageError that names the option, what was found and what is allowed.
struct ReadOptionEntry {
  const char* name;     // "merl-cell"
  const char* allowed;  // "centre|edge"
  const char* help;
  std::vector<std::string> formats;  // that look at it; empty: all
  void (*set)(ReadOptions* options, const std::string& word);
};
const std::vector<ReadOptionEntry>& ReadOptionTable();
// Throws UsageError where a file of `format` does not look at the option.
void CheckOptionOf(const ReadOptionEntry& option, const std::string& format, const std::string& file);

// f_r / value. A direction at or below the horizon, which is set aside anyway, gives 1 for its cosine.
double BrdfFactor(ValueKind kind, double cos_theta_i, double cos_theta_o);

}  // namespace lobefit
