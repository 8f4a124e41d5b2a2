// The head of a goniometer's CSV: titles and keys, the names of the columns, their units, the separator.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/io/csv/head/cells.h"
#include "lobefit/io/csv/head/keys.h"
#include "lobefit/io/csv/head/lines.h"
#include "lobefit/io/csv/head/side_tables.h"
#include "lobefit/io/csv/names/columns.h"
#include "lobefit/io/text/format.h"

namespace lobefit {

struct CsvHeader {
  std::vector<CsvColumn> columns;
  std::vector<CellForm> cells;         // one a written column, or none where all cells are bare numbers
  std::size_t written_columns = 0;     // those behind them stand for uncertainties within cells
  std::vector<SideTable> side_tables;  // where the same table stands several times beside itself, else none
  char separator = ',';
  char decimal_mark = '.';
  std::size_t names_line = 0;  // line of the column names
  std::string names;           // that line, which may come again where files were joined
  std::size_t first_data_line = 0;
  CsvKeys keys;
  // Of a table whose names are numbers, "theta\phi;-180;-150": what the numbers are.
  std::optional<Coordinate> head_coordinate;
  std::vector<std::string> remarks;
  std::vector<std::string> comments;  // and titles, which are no keys
  std::vector<std::string> titles;    // the first lines above the names and the first comments, keys too
  // The first rows as fields, for what only the numbers can tell.
  std::vector<std::vector<std::string>> first_rows;
};

// Reads up to the first row of data: the first line with at least two numbers, of which none names a column. Names are
// the last line before it that names a direction or what `columns` (--columns) maps; comment lines count. Lines before
// them are titles or keys, one below may hold units. Throws InputError with the line.
CsvHeader ReadCsvHeader(const InputFile& file, const std::string& columns);

}  // namespace lobefit
