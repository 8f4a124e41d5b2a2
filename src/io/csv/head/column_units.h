// Units that lines above a table state of its columns: "# Column 1: theta_i (rad)", "# theta_i: angle in radians".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lobefit/io/csv/names/columns.h"

namespace lobefit {

struct ColumnUnit {
  std::string column;  // a name of the column, as ClassifyColumn understands it
  std::string unit;    // as PlainUnit gives it

  bool operator==(const ColumnUnit&) const = default;
};

// What the line says of columns by their names; empty where it says nothing of units. Numbers with a unit ("theta_o: 0
// to 80 deg") are no statement of it.
std::vector<ColumnUnit> FindColumnUnits(std::string_view text);

// Gives the columns whose names have no unit of their own the stated one. Returns the first statement that contradicts
// a name; null where there is none.
const ColumnUnit* SetColumnUnits(const std::vector<ColumnUnit>& stated, std::vector<CsvColumn>* columns);

// Whether a statement amid the rows leaves the units as they are; `angles`: of columns of angles that have none.
bool KeepsUnits(const ColumnUnit& stated, const std::vector<CsvColumn>& columns, AngleUnit angles);

}  // namespace lobefit
