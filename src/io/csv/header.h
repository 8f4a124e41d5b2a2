// The head of a goniometer's CSV: comment lines with keys, column names, separator.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lobefit/io/csv/columns.h"
#include "lobefit/io/text/format.h"

namespace lobefit {

// '\0' stands for runs of blanks.
inline constexpr char kBlankSeparator = '\0';

struct CsvHeader {
  std::vector<CsvColumn> columns;
  char separator = ',';
  std::size_t names_line = 0;  // line of the column names
  std::size_t first_data_line = 0;
  // Keys of comment lines, "# angle-unit: rad" or "# angle-unit = rad".
  std::optional<AngleUnit> angle_unit;
  std::optional<ValueKind> value_kind;
  std::optional<IncidentSense> incident_sense;
  std::optional<double> nm_per_wavelength_unit;
  double sample_rotation = 0;  // radians
};

bool IsComment(std::string_view line);

// Fields of a line, untrimmed.
std::vector<std::string_view> SplitFields(std::string_view line, char separator);

// Reads up to the first row of data. Column names are the first line that is not a comment, or, where that one holds
// numbers, the last comment line before it that names the two polar angles. Throws InputError with the line.
CsvHeader ReadCsvHeader(const InputFile& file);

}  // namespace lobefit
