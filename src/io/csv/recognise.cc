// What is taken for rows of a goniometer.
#include <algorithm>
#include <string_view>
#include <vector>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/names/columns.h"
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

bool NamesDirections(const InputFile& file) {
  const auto is_direction = [](const CsvColumn& column) {
    return column.role == ColumnRole::kCoordinate || column.role == ColumnRole::kFixed;
  };
  try {
    const CsvHeader header = ReadCsvHeader(file, "");
    // Angles of incidence alone are a list of what was measured, not a measurement.
    const auto of_light = [](Coordinate coordinate) {
      return coordinate == Coordinate::kThetaI || coordinate == Coordinate::kPhiI || coordinate == Coordinate::kBeta0;
    };
    return header.head_coordinate ||
           std::any_of(header.columns.begin(), header.columns.end(),
                       [&](const CsvColumn& column) {
                         return is_direction(column) &&
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
      const auto directions = std::count_if(names.begin(), names.end(),
                                            [&](std::string_view name) { return is_direction(ClassifyColumn(name)); });
      if (directions >= 2) return true;
    }
  }
  return false;
}

}  // namespace lobefit
