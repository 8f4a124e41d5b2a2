#include "lobefit/io/csv/head/mapping.h"

#include "lobefit/base/error.h"
#include "lobefit/base/text/csv_fields.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/text/place.h"

namespace lobefit {

std::size_t FindColumn(const std::vector<CsvColumn>& columns, std::string_view name) {
  const std::string lower = ToLower(Trim(name));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (ToLower(columns[i].name) == lower) return i;
  }
  if (lower.starts_with('#')) {
    const std::optional<long long> number = ParseInteger(std::string_view(lower).substr(1));
    if (number && *number >= 1 && static_cast<std::size_t>(*number) <= columns.size())
      return static_cast<std::size_t>(*number) - 1;
  }
  return columns.size();
}

ColumnMapping::ColumnMapping(const std::string& text) {
  if (Trim(text).empty()) return;
  std::vector<std::string_view> items;
  SplitQuoted(text, ',', &items);
  std::string storage;
  for (const std::string_view item : items) {
    const std::size_t at = item.find('=');
    if (at == std::string_view::npos || Trim(item.substr(0, at)).empty() || Trim(item.substr(at + 1)).empty()) {
      throw UsageError("--columns " + Excerpt(text, 100) + ": '" + Excerpt(Trim(item)) +
                       "' is not MEANING=COLUMN; write it as in theta_i=zenith_1,theta_o=#3,f=value");
    }
    const std::string meaning(Trim(item.substr(0, at)));
    const std::string source(Unquoted(item.substr(at + 1), &storage));
    const CsvColumn column = ClassifyColumn(meaning);
    if (column.role == ColumnRole::kUnknown || column.role == ColumnRole::kNumber) {
      throw UsageError("--columns " + Excerpt(text, 100) + ": '" + Excerpt(meaning) +
                       "' is no meaning of a column; allowed: " + AllowedColumns());
    }
    if (ToLower(source) == "names") {
      if (column.role != ColumnRole::kCoordinate)
        throw UsageError("--columns " + Excerpt(text, 100) +
                         ": the names of columns can be an angle only, as in theta_i=names");
      head_ = column.coordinate;
    }
    entries_.emplace_back(meaning, source);
  }
}

void ColumnMapping::Rename(std::vector<CsvColumn>* columns) const {
  for (const auto& [meaning, source] : entries_) {
    const std::size_t at = FindColumn(*columns, source);
    if (at == columns->size()) continue;
    CsvColumn& column = (*columns)[at];
    CsvColumn renamed = ClassifyColumn(meaning);
    renamed.name = column.name;
    if (!column.unit.empty()) SetUnit(column.unit, &renamed);
    column = std::move(renamed);
  }
}

void ColumnMapping::Fix(const InputFile& file, std::size_t line, const std::vector<CsvColumn>& columns,
                        CsvKeys* keys) const {
  for (const auto& [meaning, source] : entries_) {
    if (FindColumn(columns, source) < columns.size() || ToLower(source) == "names") continue;
    if (ReadKey(file, line, meaning + ": " + source, keys)) continue;
    std::vector<std::string> names;
    for (const CsvColumn& column : columns) names.push_back(Excerpt(column.name));
    FailAtLine(file, line,
               "no column is named '" + Excerpt(source) + "', which --columns asks for; the columns are " +
                   Excerpt(Join(names), 200));
  }
}

}  // namespace lobefit
