// What the lines of a segment hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/batch/run/journal.h"
#include "lobefit/batch/run/records.h"

namespace lobefit {

struct SegmentLines {
  std::vector<DoneRecord> done;  // with the places of row and picture
  std::vector<StartRecord> started;
  std::vector<std::string> ended;  // ids of those that were begun here or in an earlier piece
  Writer writer;
  std::size_t lines_lost = 0;
  // The first line is that of a task that is done: its picture may be the last line of the piece before.
  bool begins_with_done = false;
  // Of the line before, which belongs to the next one.
  std::uint64_t picture_offset = 0, picture_bytes = 0;
  bool picture_is_measured = false;
};

// Adds one line, which begins at `offset` of the text in which places count. Throws an exception for one that is not
// whole.
void ParseLine(std::string_view line, std::uint64_t offset, SegmentLines* parsed);

}  // namespace lobefit
