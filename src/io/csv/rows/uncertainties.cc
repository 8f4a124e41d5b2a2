#include "lobefit/io/csv/rows/uncertainties.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

// The column of the uncertainties within the cells of a column, or none.
std::size_t WithinCells(const CsvHeader& header, std::size_t column) {
  const std::size_t within = header.cells.empty() ? 0 : header.cells[column].uncertainty;
  return within > 0 ? within : kNoColumn;
}

bool IsValue(const CsvLayout& layout, std::size_t column) {
  return std::any_of(layout.groups.begin(), layout.groups.end(), [&](const ValueGroup& group) {
    return std::find(group.values.begin(), group.values.end(), column) != group.values.end();
  });
}

// Whether the column stands for uncertainties within the cells of one that is not used.
bool IsOfUnusedCells(const CsvHeader& header, const CsvLayout& layout, std::size_t column) {
  for (std::size_t k = 0; k < header.cells.size(); ++k) {
    if (column >= header.written_columns && header.cells[k].uncertainty == column) return !IsValue(layout, k);
  }
  return false;
}

// In a table with a column for each angle the uncertainties stand behind their values, all of one name or none, or
// within their cells. True where there are such.
bool PairUncertainties(const InputFile& file, const CsvHeader& header, const std::vector<CsvColumn>& columns,
                       CsvLayout* layout, Measurement* notes) {
  const auto is_sigma = [](const CsvColumn& column) { return column.role == ColumnRole::kSigma; };
  if (layout->groups.size() < 2 || std::none_of(columns.begin(), columns.end(), is_sigma)) return false;
  std::size_t paired = 0;
  for (ValueGroup& group : layout->groups) {
    const std::size_t last = group.values.back(), within = WithinCells(header, last);
    const std::size_t next = within != kNoColumn ? within : last + 1;
    if (group.values.size() != 1 || next >= columns.size() || !is_sigma(columns[next])) continue;
    const CsvColumn& sigma = columns[next];
    if (sigma.fixed != 0 && sigma.fixed != columns[last].fixed) {
      FailAtLine(file, header.names_line,
                 "the column " + QuotedName(sigma) + " stands behind " + QuotedName(columns[last]) +
                     " and speaks of another angle; put each uncertainty behind its value");
    }
    group.sigma = next;
    ++paired;
  }
  if (paired == 0) return false;
  if (paired < layout->groups.size()) {
    FailAtLine(file, header.names_line,
               "only " + std::to_string(paired) + " of " + std::to_string(layout->groups.size()) +
                   " columns of values have an uncertainty behind them; give all or none");
  }
  if (layout->groups[0].sigma < header.written_columns)
    notes->remarks.push_back("the uncertainty of each column of values is the column behind it");
  return true;
}

}  // namespace

void FindUncertainties(const InputFile& file, const CsvHeader& header, const std::vector<CsvColumn>& columns,
                       CsvLayout* layout, Measurement* notes) {
  const auto fail = [&](const std::string& what) { FailAtLine(file, header.names_line, what); };
  constexpr char kBoth[] = "both weight and sigma columns are given; remove one of them";
  if (PairUncertainties(file, header, columns, layout, notes)) {
    if (layout->weight != kNoColumn) fail(kBoth);
    return;
  }
  std::map<std::string, std::size_t> by_channel;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const CsvColumn& column = columns[i];
    if (column.role != ColumnRole::kSigma || IsOfUnusedCells(header, *layout, i)) continue;
    const auto [known, is_new] = by_channel.emplace(column.channel, i);
    if (is_new || !column.problem.empty()) continue;
    if (!columns[known->second].problem.empty()) {
      known->second = i;  // the standard uncertainty, beside an expanded one of unknown factor
    } else {
      fail("two columns are named " + QuotedName(column) + "; remove one of them");
    }
  }
  if (by_channel.empty() || layout->groups.size() > 1) return;
  if (layout->weight != kNoColumn) fail(kBoth);
  if (by_channel.contains("")) {
    layout->sigma = by_channel[""];
    return;
  }
  for (const std::string& channel : layout->channels.names) {
    if (!by_channel.contains(channel))
      fail("channel " + channel + " has no column sigma_" + channel +
           ", but other channels have one; give all or none");
    layout->channel_sigmas.push_back(by_channel[channel]);
  }
}

void SpreadSideTables(const InputFile& file, const CsvHeader& header, CsvLayout* layout) {
  const std::vector<SideTable>& tables = header.side_tables;
  if (tables.empty()) return;
  if (layout->groups.size() != 1 || layout->by_wavelength || !layout->polarisations.empty() ||
      layout->weight != kNoColumn || !layout->channel_sigmas.empty() || !layout->filters.empty()) {
    FailAtLine(file, header.names_line,
               "tables of angles and one value each are read where several stand side by side; put these into files of "
               "their own, and name them all");
  }
  const ValueGroup first = std::exchange(layout->groups, {})[0];
  for (const SideTable& table : tables) {
    const auto own = [&](std::size_t column) {
      const std::vector<std::size_t>& columns = tables[0].columns;
      const auto at = std::find(columns.begin(), columns.end(), column);
      return at == columns.end() ? column : table.columns[static_cast<std::size_t>(at - columns.begin())];
    };
    ValueGroup group;
    if (table.fixed) group.fixed.emplace_back(table.fixed->coordinate, table.fixed->number);
    for (const std::size_t i : first.values) group.values.push_back(own(i));
    if (layout->sigma != kNoColumn)
      group.sigma = layout->sigma < header.written_columns ? own(layout->sigma) : WithinCells(header, group.values[0]);
    for (const auto& [coordinate, column] : layout->coordinates)
      group.coordinates.emplace_back(coordinate, own(column));
    layout->groups.push_back(std::move(group));
  }
  layout->sigma = kNoColumn;
}

}  // namespace lobefit
