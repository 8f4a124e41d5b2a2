// What a line of the head can be: names, units, a row of data.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/io/csv/head/lines.h"
#include "lobefit/io/csv/names/columns.h"

namespace lobefit {

using CsvFields = std::vector<std::string_view>;

CsvFields SplitFields(std::string_view text, char separator);

// "0,55", "-1,4e-14".
bool HasDecimalComma(std::string_view field);
// "1.234,5" and "1,234.5".
bool HasThousandsSeparator(std::string_view field);
// A number with either mark. Between commas it may have one of its own within quotes.
bool IsNumeric(std::string_view field);
// At least two numbers, at least as many of them as of anything else, and no name of a column.
bool IsData(const CsvFields& fields);
// "10,5 20,0 0,55": blanks stand between the numbers, which commas cut to pieces.
bool HasCommasWithinNumbers(std::string_view text, const CsvFields& by_commas);

std::vector<CsvColumn> Classify(const CsvFields& names);
bool NamesADirection(const std::vector<CsvColumn>& columns);
// The names in a line; where they are not as many as the `wanted` fields of a row, and another way to divide the line
// gives just as many, it is that one ("theta_i,theta_o,brdf" above rows with semicolons).
CsvFields SplitNames(std::string_view text, char separator, std::size_t wanted);
// "theta\phi": rows and columns of a table of one incidence.
bool IsCorner(std::string_view name, CsvColumn* rows, Coordinate* columns);
// Cells of a merged heading, which stand empty but for the first, before the names below them.
std::vector<std::string> Combined(const CsvFields& upper, const CsvFields& lower);
// A unit of anything, also "-" and "1".
bool IsUnitOrBlank(std::string_view field);

}  // namespace lobefit
