// What is taken for rows of a goniometer.
#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/head_text.h"
#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/names/columns.h"
#include "lobefit/io/csv/names/name_rules.h"
#include "lobefit/io/csv/reader.h"

namespace lobefit {

bool IsCsv(std::string_view bytes) {
  CsvLines lines(bytes.substr(0, kCsvHeadBytes));
  std::string_view line;
  bool separators = false;
  while (lines.Next(&line)) {
    for (const char c : line) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') return false;
    }
    if (Trim(line).empty() || IsComment(line)) continue;
    separators = separators || line.find_first_of(",;\t|") != std::string_view::npos;
    if (separators) return true;
    // Words between blanks are prose, unless they are numbers or two of them name columns.
    std::size_t numbers = 0, named = 0;
    const std::vector<std::string_view> words = SplitBlanks(line);
    for (const std::string_view word : words) {
      numbers += ParseDouble(word).has_value() ? 1 : 0;
      const CsvColumn column = ClassifyColumn(word);
      named += column.role == ColumnRole::kCoordinate || column.role == ColumnRole::kValue ? 1 : 0;
    }
    if (words.size() >= 2 && (numbers == words.size() || named >= 2)) return true;
  }
  return false;
}

namespace {

bool IsDirection(const CsvColumn& column) {
  return column.role == ColumnRole::kCoordinate || column.role == ColumnRole::kFixed;
}

// What is there beside directions may hold values, under whatever name; so may what a detector gave, which needs
// --value-column.
bool MayHoldValues(const CsvColumn& column) {
  static constexpr std::array<std::string_view, 8> kSignals = {"radiance", "raw",     "l_o_raw", "counts",
                                                               "signal",   "voltage", "current", "power"};
  if (column.role == ColumnRole::kIgnored) return HoldsWord(kSignals, Joined(SplitName(column.name).words));
  return column.role != ColumnRole::kCoordinate;
}

// A line of names: of prose that speaks of two angles most words are no names.
bool IsLineOfNames(const std::vector<std::string_view>& fields) {
  std::size_t directions = 0, unknown = 0;
  for (const std::string_view field : fields) {
    const CsvColumn column = ClassifyColumn(field);
    directions += IsDirection(column) ? 1 : 0;
    unknown += column.role == ColumnRole::kUnknown ? 1 : 0;
  }
  return directions >= 2 && unknown <= directions;
}

}  // namespace

bool NamesDirections(const InputFile& file) {
  try {
    const CsvHeader header = ReadCsvHeader(file, "");
    // Angles of incidence alone are a list of what was measured, not a measurement.
    const auto of_light = [](Coordinate coordinate) {
      return coordinate == Coordinate::kThetaI || coordinate == Coordinate::kPhiI || coordinate == Coordinate::kBeta0;
    };
    // So are directions alone, as a text has them in a table that says what was measured.
    if (std::none_of(header.columns.begin(), header.columns.end(), MayHoldValues)) return false;
    return header.head_coordinate ||
           std::any_of(header.columns.begin(), header.columns.end(),
                       [&](const CsvColumn& column) {
                         return IsDirection(column) &&
                                (column.role == ColumnRole::kFixed || !of_light(column.coordinate));
                       }) ||
           std::any_of(header.keys.fixed.begin(), header.keys.fixed.end(),
                       [&](const FixedCoordinate& fixed) { return !of_light(fixed.coordinate); });
  } catch (const InputError&) {
    // Such as a file that ends after its names.
  }
  CsvLines lines(file.bytes.substr(0, 1 << 16));
  std::string_view line;
  while (lines.Next(&line)) {
    for (const char separator : {',', ';', '\t', '|', kBlankSeparator}) {
      std::vector<std::string_view> names;
      SplitCsvLine(IsComment(line) ? CommentText(line) : line, separator, &names);
      if (IsLineOfNames(names)) return true;
    }
  }
  return false;
}

}  // namespace lobefit
