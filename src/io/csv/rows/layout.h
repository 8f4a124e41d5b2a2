// Which column of a goniometer's CSV holds what: the names of the head, matched with the options and the first rows.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/names/directions.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

inline constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);

// Columns of values that share their directions: all of them, those at one angle of a table that has a column for
// each angle, or that of one polarisation.
struct ValueGroup {
  std::vector<std::pair<Coordinate, double>> fixed;
  std::vector<std::size_t> values;
  std::string polarisation = {};  // empty: a column of the row says it, or nothing does
  std::size_t sigma = kNoColumn;  // of a table with one behind each column of values
  std::vector<std::pair<Coordinate, std::size_t>> coordinates = {};  // of one of several tables side by side
};

// A column of which only rows with this text are used.
struct RowFilter {
  std::size_t column = kNoColumn;
  std::string word;
};

// Which field of a row holds what.
struct CsvLayout {
  DirectionReader directions;
  Coordinates fixed = {};                                       // coordinates that all rows share
  std::vector<std::pair<Coordinate, std::size_t>> coordinates;  // and those of columns
  std::size_t wavelength = kNoColumn, weight = kNoColumn, sigma = kNoColumn;
  std::vector<std::size_t> polarisations;  // at most that of the light and that of the viewer
  WavelengthUnit wavelength_unit;
  bool by_wavelength = false;  // each row has a wavelength, its own or one stated in the head
  std::vector<ValueGroup> groups;
  std::vector<std::size_t> channel_sigmas;  // one a channel, or empty
  std::vector<std::size_t> unused;          // columns that are not used and may tell rows apart
  std::vector<RowFilter> filters;
  Channels channels;
  ValueKind value_kind = ValueKind::kBrdf;
  ValueScale value_scale;
  std::vector<bool> is_number;  // one a column: its number is needed

  std::size_t ChannelCount() const { return channels.size(); }
};

// Throws InputError, which names the line, for a column that is missing, unknown, given twice or one of several that
// could be the value. Adds what it chose to the conventions and remarks of `notes`.
CsvLayout ReadCsvLayout(const InputFile& file, const CsvHeader& header, const ReadOptions& options, Measurement* notes);

}  // namespace lobefit
