#include "lobefit/io/csv/head/head_lines.h"

#include <algorithm>

#include "lobefit/base/text/csv_fields.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

// "Date: 12", which a comma may split from what follows.
bool IsKeyed(std::string_view field) {
  const std::size_t mark = field.find_first_of(":=");
  return mark != std::string_view::npos && mark > 0 &&
         std::any_of(field.begin(), field.begin() + static_cast<std::ptrdiff_t>(mark),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); });
}

bool NamesAnything(std::string_view field) {
  std::string storage;
  const CsvColumn column = ClassifyColumn(Unquoted(field, &storage));
  return column.role == ColumnRole::kCoordinate || column.role == ColumnRole::kValue ||
         column.role == ColumnRole::kWavelength || (column.role == ColumnRole::kFixed && !column.fixed_incidence);
}

// Names of several words: what runs of blanks or tabs divide, or else words with their units in brackets.
CsvFields SplitWords(std::string_view text, bool by_runs) {
  CsvFields fields;
  std::size_t begin = std::string_view::npos, end = 0;
  for (const std::string_view word : SplitBlanks(text)) {
    const auto at = static_cast<std::size_t>(word.data() - text.data());
    const std::string_view gap = text.substr(end, at - end);
    const bool apart = by_runs ? gap.size() > 1 || gap == "\t" : word.front() != '(' && word.front() != '[';
    if (begin != std::string_view::npos && apart) fields.push_back(text.substr(begin, end - begin));
    if (begin == std::string_view::npos || apart) begin = at;
    end = at + word.size();
  }
  if (begin != std::string_view::npos) fields.push_back(text.substr(begin, end - begin));
  return fields;
}

}  // namespace

CsvFields SplitFields(std::string_view text, char separator) {
  CsvFields fields;
  SplitCsvLine(text, separator, &fields);
  return fields;
}

bool HasDecimalComma(std::string_view field) {
  const std::size_t comma = field.find(',');
  if (comma == std::string_view::npos) return false;
  std::string point(field);
  point[comma] = '.';
  return ParseDouble(point).has_value();
}

bool HasThousandsSeparator(std::string_view field) {
  const std::size_t comma = field.find(','), point = field.find('.');
  if (comma == std::string_view::npos || point == std::string_view::npos) return false;
  return field.find_first_not_of("+-0123456789.,") == std::string_view::npos;
}

bool IsNumeric(std::string_view field) {
  std::string storage;
  field = Unquoted(field, &storage);
  return ParseCsvNumber(field, '.') || HasDecimalComma(field) || HasThousandsSeparator(field);
}

bool IsData(const CsvFields& fields) {
  std::size_t numbers = 0, others = 0;
  for (const std::string_view field : fields) {
    if (IsNumeric(field)) {
      ++numbers;
    } else if (!Trim(field).empty()) {
      ++others;
    }
  }
  if (numbers < 2 || numbers < others) return false;
  return others == 0 || std::none_of(fields.begin(), fields.end(), [&](std::string_view field) {
           return !IsNumeric(field) && !Trim(field).empty() && (IsKeyed(field) || NamesAnything(field));
         });
}

bool HasCommasWithinNumbers(std::string_view text, const CsvFields& by_commas) {
  if (std::all_of(by_commas.begin(), by_commas.end(), IsNumeric)) return false;
  const CsvFields by_blanks = SplitFields(text, kBlankSeparator);
  return by_blanks.size() > 1 && std::all_of(by_blanks.begin(), by_blanks.end(), [](std::string_view field) {
           return !field.ends_with(',') && IsNumeric(field);
         });
}

std::vector<CsvColumn> Classify(const CsvFields& names) {
  std::vector<CsvColumn> columns;
  std::string storage;
  for (const std::string_view name : names) columns.push_back(ClassifyColumn(Unquoted(name, &storage)));
  return columns;
}

bool NamesADirection(const std::vector<CsvColumn>& columns) {
  // "45as15" alone begins a row.
  const auto geometries = std::count_if(columns.begin(), columns.end(),
                                        [](const CsvColumn& column) { return column.fixed_incidence.has_value(); });
  if (geometries == 1) return false;
  return columns.size() > 1 && std::any_of(columns.begin(), columns.end(), [](const CsvColumn& column) {
           return column.role == ColumnRole::kCoordinate || column.role == ColumnRole::kFixed;
         });
}

CsvFields SplitNames(std::string_view text, char separator, std::size_t wanted) {
  const CsvFields fields = SplitFields(text, separator);
  if (fields.size() == wanted || wanted < 2) return fields;
  std::vector<CsvFields> others;
  for (const char other : {';', '\t', '|', ','}) others.push_back(SplitFields(text, other));
  if (separator == kBlankSeparator) {
    others.push_back(SplitWords(text, true));
    others.push_back(SplitWords(text, false));
  }
  for (const CsvFields& other : others) {
    if (other.size() == wanted && NamesADirection(Classify(other))) return other;
  }
  return fields;
}

bool IsCorner(std::string_view name, CsvColumn* rows, Coordinate* columns) {
  std::string storage;
  name = Unquoted(name, &storage);
  const std::size_t at = name.find_first_of("\\/|");
  if (at == std::string_view::npos) return false;
  const CsvColumn left = ClassifyColumn(name.substr(0, at)), right = ClassifyColumn(name.substr(at + 1));
  if (left.role != ColumnRole::kCoordinate || right.role != ColumnRole::kCoordinate ||
      left.coordinate == right.coordinate)
    return false;
  *rows = left;
  rows->name = std::string(name);
  *columns = right.coordinate;
  return true;
}

bool IsUnitOrBlank(std::string_view field) {
  std::string storage;
  std::string_view text = Unquoted(field, &storage);
  if (text.size() > 1 && (text.front() == '(' || text.front() == '[')) text = text.substr(1, text.size() - 2);
  return Trim(text).empty() || ParseAngleUnit(text) || ParseValueScale(text) || ParseWavelengthUnit(text) ||
         Trim(text) == "#" || ToLower(Trim(text)) == "grad";
}

std::vector<std::string> Combined(const CsvFields& upper, const CsvFields& lower) {
  std::vector<std::string> names;
  std::string heading, storage;
  for (std::size_t i = 0; i < lower.size(); ++i) {
    if (i < upper.size() && !Trim(upper[i]).empty()) heading = std::string(Unquoted(upper[i], &storage));
    names.push_back(heading + " " + std::string(Unquoted(lower[i], &storage)));
  }
  return names;
}

}  // namespace lobefit
