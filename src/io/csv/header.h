// The head of a goniometer's CSV: titles and keys, the names of the columns, their units, the separator.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/base/text.h"
#include "lobefit/io/csv/columns.h"
#include "lobefit/io/csv/keys.h"
#include "lobefit/io/text/format.h"

namespace lobefit {

// '\0' stands for runs of blanks.
inline constexpr char kBlankSeparator = '\0';

struct CsvHeader {
  std::vector<CsvColumn> columns;
  char separator = ',';
  char decimal_mark = '.';
  std::size_t names_line = 0;  // line of the column names
  std::string names;           // that line, which may come again where files were joined
  std::size_t first_data_line = 0;
  CsvKeys keys;
  // Of a table whose names are numbers, "theta\phi;-180;-150": what the numbers are.
  std::optional<Coordinate> head_coordinate;
  std::vector<std::string> remarks;
  // The first rows as fields, for what only the numbers can tell.
  std::vector<std::vector<std::string>> first_rows;
};

bool IsComment(std::string_view line);
std::string_view CommentText(std::string_view line);

// Lines of a CSV; a quoted field may hold line ends, and its line goes on.
class CsvLines {
 public:
  explicit CsvLines(std::string_view bytes);
  bool Next(std::string_view* line);
  // Line in which the text of Next begins.
  std::size_t line_number() const { return first_line_; }

 private:
  std::string_view bytes_;
  LineReader lines_;
  bool has_quotes_;
  std::size_t first_line_ = 0;
};

// Fields of a line, as written.
void SplitCsvLine(std::string_view line, char separator, std::vector<std::string_view>* fields);

// Whether the field is a number as the file writes them.
std::optional<double> ParseCsvNumber(std::string_view field, char decimal_mark);

// Reads up to the first row of data: the first line with at least two numbers, of which none names a column. Names are
// the last line before it that names a direction or what `columns` (--columns) maps; comment lines count. Lines before
// them are titles or keys, one below may hold units. Throws InputError with the line.
CsvHeader ReadCsvHeader(const InputFile& file, const std::string& columns);

}  // namespace lobefit
