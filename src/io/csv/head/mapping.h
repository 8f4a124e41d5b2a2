// --columns: which column of a CSV means what, where its name does not say so.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lobefit/io/csv/head/keys.h"
#include "lobefit/io/csv/names/columns.h"

namespace lobefit {

// "theta_i=zenith_1,f=Messwert,theta_o=#3,phi_i=30,theta_i=names": a meaning by any of its usual names, and the name of
// a column, its number, a value for all rows, or "names" for the numbers that the names of the other columns are.
class ColumnMapping {
 public:
  ColumnMapping() = default;
  // Throws UsageError for what is not MEANING=COLUMN, or a meaning that is not known.
  explicit ColumnMapping(const std::string& text);

  bool empty() const { return entries_.empty(); }
  // Gives the columns that are named their meaning; their units stay.
  void Rename(std::vector<CsvColumn>* columns) const;
  // Puts values for all rows among the keys. Throws InputError for a name that no column has.
  void Fix(const InputFile& file, std::size_t line, const std::vector<CsvColumn>& columns, CsvKeys* keys) const;
  // The coordinate that the names of the columns give.
  std::optional<Coordinate> head() const { return head_; }

 private:
  std::vector<std::pair<std::string, std::string>> entries_;  // meaning, source
  std::optional<Coordinate> head_;
};

// The column of that name, case aside, or of that number ("#3"); the number of columns where there is none.
std::size_t FindColumn(const std::vector<CsvColumn>& columns, std::string_view name);

}  // namespace lobefit
