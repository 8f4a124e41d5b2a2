// The head of a CSV file as lines, and where and how its rows begin.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "lobefit/io/csv/head/lines.h"
#include "lobefit/io/text/format.h"

namespace lobefit {

// A head ends within so much of the file.
inline constexpr std::size_t kCsvHeadBytes = std::size_t{1} << 20;

struct HeadLine {
  std::size_t number = 0;
  std::string_view text;  // in the file's bytes
  bool comment = false;
};

struct HeadText {
  std::vector<HeadLine> lines;  // none that is blank; with the first rows
  std::size_t last_line = 1;    // that was looked at
  std::size_t first_row = 0;    // index of the first row of data; lines.size(): there is none
  char separator = kBlankSeparator;
  char decimal_mark = '.';
};

// Throws InputError with the line for more columns than are read, and for numbers whose commas or points cannot be told
// from separators of thousands.
HeadText ReadHeadText(const InputFile& file);

}  // namespace lobefit
