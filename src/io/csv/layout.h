// Which column of a goniometer's CSV holds what: the names of the head, matched with the options.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/io/csv/header.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

inline constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);

// Which field of a row holds what.
struct CsvLayout {
  std::size_t theta_i = kNoColumn, phi_i = kNoColumn, theta_o = kNoColumn, phi_o = kNoColumn, delta_phi = kNoColumn,
              azimuth = kNoColumn;
  std::size_t wavelength = kNoColumn, weight = kNoColumn, sigma = kNoColumn;
  std::vector<std::size_t> values;
  std::vector<std::size_t> channel_sigmas;  // one a channel, or empty
  Channels channels;
  ValueKind value_kind = ValueKind::kBrdf;
  std::vector<bool> is_read;  // one a column
};

// Throws InputError, which names the line, for a column that is missing, unknown, given twice or one of several that
// could be the value. Adds what it chose to the conventions and remarks of `notes`.
CsvLayout ReadCsvLayout(const InputFile& file, const CsvHeader& header, const ReadOptions& options, Measurement* notes);

}  // namespace lobefit
