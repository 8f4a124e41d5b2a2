#include "lobefit/io/csv/head/side_tables.h"

#include <algorithm>
#include <string>

#include "lobefit/base/text/csv_fields.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

bool MeanTheSame(const CsvColumn& a, const CsvColumn& b) {
  if (a.role != b.role || a.unit != b.unit) return false;
  if (a.role == ColumnRole::kUnknown || a.role == ColumnRole::kIgnored) return ToLower(a.name) == ToLower(b.name);
  return a.coordinate == b.coordinate && a.form == b.form && a.channel == b.channel && a.value_kind == b.value_kind;
}

// What the cells above columns `first` to `last` say.
std::optional<FixedCoordinate> HeadingOf(const std::vector<std::string_view>& headings, std::size_t first,
                                         std::size_t last) {
  std::string storage;
  for (std::size_t i = first; i <= last && i < headings.size(); ++i) {
    const std::string_view text = Unquoted(headings[i], &storage);
    if (Trim(text).empty()) continue;
    const CsvColumn column = ClassifyColumn(text);
    if (column.role != ColumnRole::kFixed) return std::nullopt;
    return FixedCoordinate{column.coordinate, column.fixed, column.angle_unit, column.form};
  }
  return std::nullopt;
}

}  // namespace

std::vector<SideTable> FindSideTables(const std::vector<std::string_view>& headings, std::size_t written_columns,
                                      std::vector<CsvColumn>* columns) {
  std::vector<std::size_t> filled;
  for (std::size_t i = 0; i < written_columns; ++i) {
    if (!(*columns)[i].name.empty()) filled.push_back(i);
  }
  const auto again = std::find_if(filled.begin() + (filled.empty() ? 0 : 1), filled.end(),
                                  [&](std::size_t i) { return MeanTheSame((*columns)[filled[0]], (*columns)[i]); });
  const auto width = static_cast<std::size_t>(again - filled.begin());
  if (again == filled.end() || filled.size() % width != 0) return {};
  const bool values = std::any_of(filled.begin(), again, [&](std::size_t i) {
    const ColumnRole role = (*columns)[i].role;
    return role == ColumnRole::kValue || role == ColumnRole::kOtherValue || role == ColumnRole::kChannel;
  });
  if (!values) return {};
  for (std::size_t k = width; k < filled.size(); ++k) {
    if (!MeanTheSame((*columns)[filled[k]], (*columns)[filled[k % width]])) return {};
  }
  std::vector<SideTable> tables;
  for (std::size_t begin = 0; begin < filled.size(); begin += width) {
    const auto at = filled.begin() + static_cast<std::ptrdiff_t>(begin);
    SideTable table = {{at, at + static_cast<std::ptrdiff_t>(width)}, {}};
    table.fixed = HeadingOf(headings, table.columns.front(), table.columns.back());
    if (!tables.empty()) {
      const std::optional<FixedCoordinate>& first = tables[0].fixed;
      if (first.has_value() != table.fixed.has_value()) return {};
      if (first && (first->coordinate != table.fixed->coordinate || first->unit != table.fixed->unit ||
                    first->form != table.fixed->form))
        return {};
    }
    tables.push_back(std::move(table));
  }
  for (std::size_t t = 1; t < tables.size(); ++t) {
    for (const std::size_t i : tables[t].columns) (*columns)[i].role = ColumnRole::kIgnored;
  }
  return tables;
}

}  // namespace lobefit
