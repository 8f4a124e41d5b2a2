// How far the angles of the rows reach, as the file states them.
#pragma once

#include <utility>
#include <vector>

#include "lobefit/io/csv/rows/layout.h"
#include "lobefit/io/csv/rows/row_parser.h"
#include "lobefit/io/csv/rows/stated_angles.h"

namespace lobefit {

class AngleRanges {
 public:
  explicit AngleRanges(const CsvLayout& layout);

  void Add(const RowParser& row) {
    for (Range& range : ranges_) {
      const double number = row.Number(range.column);
      range.low = number < range.low ? number : range.low;
      range.high = number > range.high ? number : range.high;
    }
  }
  // In degrees, for the check of conventions; `at` holds the angles that no column gives.
  StatedAngles State(const CsvLayout& layout, const Coordinates& at) const;

 private:
  // In the file's units.
  struct Range {
    Coordinate coordinate;
    std::size_t column;
    double low, high;
  };
  std::vector<Range> ranges_;
};

}  // namespace lobefit
