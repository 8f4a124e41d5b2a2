// The header of an ALTA file and what it says about the columns.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/io/alta/directions.h"
#include "lobefit/io/text/format.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// The comment by which a file of this program says of its confidence intervals what the format leaves open.
inline constexpr std::string_view kAltaSigma = "confidence intervals: one standard deviation of each value";

struct AltaEntry {
  std::string value;
  std::size_t line;
};

struct AltaHeader {
  std::map<std::string, AltaEntry> keys;
  std::vector<std::string> comments;
  bool sigma = false;        // the intervals are standard deviations, as kAltaSigma says
  bool ended = false;        // by an end mark
  bool stream = false;       // by #BEGIN_STREAM
  std::size_t end = 0;       // offset of the first byte after the header
  std::size_t end_line = 0;  // number of its last line
};

// Stops at the first line that is no header, an end mark or #BEGIN_STREAM. Fails for a key that occurs twice.
AltaHeader ReadAltaHeader(const InputFile& file);

// The entry of a key; FindKey gives null and RequireKey fails where the key is missing.
const AltaEntry* FindKey(const AltaHeader& header, const std::string& key);
const AltaEntry& RequireKey(const InputFile& file, const AltaHeader& header, const std::string& key,
                            const std::string& example);

// What the columns of a row are.
struct AltaLayout {
  const AltaInput* input = nullptr;
  std::size_t outputs = 0;
  std::vector<int> intervals;  // columns of confidence of each output: 0, 1 or 2
  bool one_interval_number = false;
  ValueKind kind = ValueKind::kBrdf;
  bool kind_from_option = false;
  bool kind_not_stated = false;  // no #PARAM_OUT and no option: taken as f_r to describe the file by
  Channels channels;

  std::size_t interval_columns() const {
    std::size_t sum = 0;
    for (const int columns : intervals) sum += static_cast<std::size_t>(columns);
    return sum;
  }
};

// Fails where #DIM, #PARAM_IN, #PARAM_OUT and #VS do not fit each other or are not known.
AltaLayout ReadAltaLayout(const InputFile& file, const AltaHeader& header, const ReadOptions& options);

}  // namespace lobefit
