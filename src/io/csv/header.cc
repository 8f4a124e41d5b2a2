#include "lobefit/io/csv/header.h"

#include <cmath>
#include <utility>

#include "lobefit/base/text.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

std::string_view CommentText(std::string_view line) {
  line = Trim(line);
  line.remove_prefix(line.starts_with("//") ? 2 : 1);
  return Trim(line);
}

char FindSeparator(std::string_view line) {
  for (const char candidate : {';', '\t', ','}) {
    if (line.find(candidate) != std::string_view::npos) return candidate;
  }
  return kBlankSeparator;
}

bool AllNumbers(const std::vector<std::string_view>& fields) {
  for (const std::string_view field : fields) {
    if (!ParseDouble(field)) return false;
  }
  return true;
}

std::vector<CsvColumn> Classify(const std::vector<std::string_view>& names) {
  std::vector<CsvColumn> columns;
  for (const std::string_view name : names) columns.push_back(ClassifyColumn(name));
  return columns;
}

bool NamesPolarAngles(const std::vector<CsvColumn>& columns) {
  bool theta_i = false, theta_o = false;
  for (const CsvColumn& column : columns) {
    theta_i = theta_i || column.role == ColumnRole::kThetaI;
    theta_o = theta_o || column.role == ColumnRole::kThetaO;
  }
  return theta_i && theta_o;
}

template <class Value>
void Set(const InputFile& file, std::size_t line, std::string_view key, std::string_view word,
         const std::string& allowed, const std::optional<Value>& value, std::optional<Value>* target) {
  if (!value) {
    FailAtLine(file, line, std::string(key) + " is '" + Excerpt(word) + "'; allowed are " + allowed);
  }
  *target = value;
}

// Takes "key: value" and "key = value"; any other comment is prose.
void ReadKey(const InputFile& file, std::size_t line, std::string_view comment, CsvHeader* header) {
  const std::size_t at = comment.find_first_of(":=");
  if (at == std::string_view::npos) return;
  const std::string key = ToLower(Trim(comment.substr(0, at)));
  const std::string_view word = Trim(comment.substr(at + 1));
  if (key == "angle-unit") {
    Set(file, line, key, word, "deg, rad", ParseAngleUnit(word), &header->angle_unit);
  } else if (key == "value-kind") {
    Set(file, line, key, word, AllowedValueKinds(), ParseValueKind(word), &header->value_kind);
  } else if (key == "incident") {
    Set(file, line, key, word, "towards, propagation", ParseIncidentSense(word), &header->incident_sense);
  } else if (key == "wavelength-unit") {
    const std::string unit = ToLower(word);
    std::optional<double> scale;
    if (unit == "nm") scale = 1;
    if (unit == "um") scale = 1e3;
    if (unit == "m") scale = 1e9;
    Set(file, line, key, word, "nm, um, m", scale, &header->nm_per_wavelength_unit);
  } else if (key == "sample-rotation-deg") {
    const std::optional<double> degrees = ParseDouble(word);
    if (!degrees || !std::isfinite(*degrees)) {
      FailAtLine(file, line, "sample-rotation-deg is '" + Excerpt(word) + "'; a number of degrees is allowed");
    }
    header->sample_rotation = DegreesToRadians(*degrees);
  } else if (key.find('-') != std::string::npos) {
    // A misspelt key would leave the file read in the wrong unit without a word.
    const std::string suggestion =
        DidYouMean(key, {"angle-unit", "value-kind", "wavelength-unit", "sample-rotation-deg"});
    if (!suggestion.empty()) FailAtLine(file, line, "the key '" + Excerpt(key) + "' is not known" + suggestion);
  }
}

}  // namespace

bool IsComment(std::string_view line) {
  line = Trim(line);
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

std::vector<std::string_view> SplitFields(std::string_view line, char separator) {
  return separator == kBlankSeparator ? SplitBlanks(line) : Split(line, separator);
}

CsvHeader ReadCsvHeader(const InputFile& file) {
  CsvHeader header;
  LineReader lines(file.bytes);
  std::string_view line;
  std::vector<std::pair<std::size_t, std::string_view>> comments;
  while (lines.Next(&line)) {
    if (lines.line_number() == 1 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    if (Trim(line).empty()) continue;
    if (!IsComment(line)) break;
    comments.emplace_back(lines.line_number(), CommentText(line));
    ReadKey(file, lines.line_number(), comments.back().second, &header);
    line = {};
  }
  if (Trim(line).empty()) FailAtLine(file, lines.line_number(), "the file ends before a line of column names");
  header.separator = FindSeparator(line);
  const std::vector<std::string_view> fields = SplitFields(line, header.separator);
  if (!AllNumbers(fields)) {
    header.columns = Classify(fields);
    header.names_line = lines.line_number();
    header.first_data_line = lines.line_number() + 1;
    return header;
  }
  header.first_data_line = lines.line_number();
  for (auto comment = comments.rbegin(); comment != comments.rend(); ++comment) {
    const std::vector<std::string_view> names = SplitFields(comment->second, header.separator);
    std::vector<CsvColumn> columns = Classify(names);
    if (!NamesPolarAngles(columns)) continue;
    header.columns = std::move(columns);
    header.names_line = comment->first;
    if (names.size() != fields.size()) {
      FailAtLine(file, header.first_data_line,
                 "has " + std::to_string(fields.size()) + " fields, but line " + std::to_string(header.names_line) +
                     " names " + std::to_string(names.size()) + " columns");
    }
    return header;
  }
  FailAtLine(file, header.first_data_line,
             "numbers begin, but no line names the columns; write a line of names first. Allowed: " + AllowedColumns());
}

}  // namespace lobefit
