// What the lines of a segment hold.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/batch/run/journal.h"
#include "lobefit/batch/run/records.h"

namespace lobefit {

struct SegmentLines {
  std::vector<DoneRecord> done;  // with the place of the row within its line
  std::vector<StartRecord> started;
  std::vector<std::string> ended;  // ids of those that were begun here or in an earlier piece
  Writer writer;
  std::size_t lines_lost = 0;
};

// Adds one line. Throws an exception for one that is not whole.
void ParseLine(std::string_view line, SegmentLines* parsed);

}  // namespace lobefit
