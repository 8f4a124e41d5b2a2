// What cells hold beside their numbers: a unit, as in "12.5 deg", or an uncertainty, as in "0.31 ± 0.02", "0.310(12)".
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/io/csv/names/columns.h"
#include "lobefit/io/text/format.h"

namespace lobefit {

// Numbers and unit of a cell; the uncertainty is in the unit of the number.
struct Cell {
  double number = 0;
  std::optional<double> uncertainty;
  std::string unit;  // as PlainUnit gives it
};

// Nothing for a cell that is more than a number with its uncertainty and a unit of an angle, a wavelength or a value,
// and for "31 ± 2 %", which can be 2 % of 31 as well as 2 of 31 %.
std::optional<Cell> ParseCell(std::string_view field, char decimal_mark);

// The number as it is written, without what stands behind it; the field where it does not begin with one.
std::string_view NumberOfCell(std::string_view field);

// What the cells of one column hold.
struct CellForm {
  std::string unit;             // empty: bare numbers
  std::string suffix;           // as it stands behind the number of the first such cell
  std::size_t uncertainty = 0;  // the column that stands for the uncertainties in the cells; 0: there are none
};

// Looks at the first rows: gives columns the unit of their cells, and adds a column behind the written ones for each
// whose cells hold uncertainties. Nothing where all cells are bare. Throws InputError where cells of a column, or its
// name, speak of two units.
std::vector<CellForm> TakeCells(const InputFile& file, std::size_t line,
                                const std::vector<std::vector<std::string>>& first_rows, char decimal_mark,
                                std::vector<CsvColumn>* columns);

}  // namespace lobefit
