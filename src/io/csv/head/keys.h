// Keys of a goniometer's CSV: "# angle-unit: rad", "Wavelength (nm) = 633", "AOI;30;deg".
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/io/csv/head/column_units.h"
#include "lobefit/io/csv/names/columns.h"
#include "lobefit/io/text/format.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// A coordinate that is the same for all rows.
struct FixedCoordinate {
  Coordinate coordinate = Coordinate::kThetaI;
  double number = 0;
  std::optional<AngleUnit> unit;  // unset: that of the file
  AngleForm form = AngleForm::kPolar;
  friend bool operator==(const FixedCoordinate&, const FixedCoordinate&) = default;
};

// Where a sentence says that the viewer's angles count from.
enum class ViewerZero { kNotSaid, kMirror, kIncidentBeam };

struct CsvKeys {
  std::optional<AngleUnit> angle_unit;
  std::optional<ValueKind> value_kind;
  std::optional<ValueScale> value_scale;
  std::optional<IncidentSense> incident_sense;
  std::optional<WavelengthUnit> wavelength_unit;
  std::optional<double> wavelength_nm;
  StatedInstrument instrument;
  ViewerZero viewer_zero = ViewerZero::kNotSaid;
  bool light_from_surface = false, viewer_from_surface = false;  // polar angles, where a sentence says so
  std::vector<FixedCoordinate> fixed;  // each coordinate at most once
  std::string mention_of_incidence;    // the line that theta_i is from, where it is no key (ReadMention)
  std::string lone_azimuth;            // "Azimuth: 90", whose it is not said
  std::string columns, where, no_value, exclude, value_column, repeated;
  std::vector<ColumnUnit> column_units;
  std::vector<std::string> remarks;  // keys that resemble a known one

  void Fix(const FixedCoordinate& coordinate);
  const FixedCoordinate* Find(Coordinate coordinate) const;
};

// Takes "key: value" and "key = value", however the key is spelt: case, "_", "-" and blanks are alike. False for prose.
// Throws InputError for a value that the key does not allow, and for a key within two letters of one that is known.
bool ReadKey(const InputFile& file, std::size_t line, std::string_view text, CsvKeys* keys);

// The same for the fields of a line: "AOI", "30", "deg".
bool ReadKey(const InputFile& file, std::size_t line, const std::vector<std::string_view>& fields, CsvKeys* keys);

// Throws InputError where keys that stand amid the rows change what was read with others before them; coordinates may
// change, they begin a new part of the file.
void RequireSameUnits(const InputFile& file, std::size_t line, const CsvKeys& before, const CsvKeys& after);

}  // namespace lobefit
