// The polarisations of rows, by a column or by which column of values they stand in, made one of unpolarised light.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/rows/layout.h"
#include "lobefit/io/csv/rows/row_parser.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

class RowPolarisations {
 public:
  // Both are kept by reference, and may be filled later.
  RowPolarisations(const CsvHeader& header, const CsvLayout& layout) : header_(header), layout_(layout) {}

  bool any() const { return !layout_.polarisations.empty() || !layout_.groups[0].polarisation.empty(); }
  // Of the light and of the viewer together, where the row has both: an index in the order in which they come. Throws
  // InputError for more than 200 of them.
  std::uint8_t NumberOf(const RowParser& row, const ValueGroup& group);
  // Of a sample that was taken, in order.
  void Add(const RowParser& row, const ValueGroup& group) { of_samples_.push_back(NumberOf(row, group)); }
  // The option that chooses the first of them.
  std::string Choice() const;
  // See AverageOverPolarisation; the remark says how one is chosen.
  std::string Average(Measurement* measurement) const;

 private:
  const CsvHeader& header_;
  const CsvLayout& layout_;
  std::vector<std::uint8_t> of_samples_;
  std::vector<std::string> names_;
  std::string first_;
};

}  // namespace lobefit
