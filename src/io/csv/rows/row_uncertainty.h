// The weight of a row, or the standard deviation of its f_r, from the columns that state them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/rows/layout.h"
#include "lobefit/io/csv/rows/row_parser.h"

namespace lobefit {

class RowUncertainty {
 public:
  // All are kept by reference, and may be filled later.
  RowUncertainty(const InputFile& file, const CsvHeader& header, const CsvLayout& layout)
      : file_(file), header_(header), layout_(layout) {}

  bool HasSigmas() const {
    return layout_.sigma != kNoColumn || !layout_.channel_sigmas.empty() || layout_.groups[0].sigma != kNoColumn;
  }
  bool HasWeights() const { return layout_.weight != kNoColumn || HasSigmas(); }

  // The row's weight, or the standard deviation of its f_r (root mean square over the channels; NaN where it is not
  // known), which takes the weight's place until all rows are known; `factor` makes f_r of a value. False where the
  // file gives the row no weight. Throws InputError for a number that is neither.
  bool Find(const RowParser& row, const ValueGroup& group, std::size_t line, double factor, double* weight) const;

 private:
  double StandardDeviation(const CsvColumn& column, double number, double value) const;

  const InputFile& file_;
  const CsvHeader& header_;
  const CsvLayout& layout_;
};

// A sample without an uncertainty gets the middle one of the others; all are dropped where none is known. Says so in
// `remarks`.
void FillUnknown(std::vector<double>* sigma, std::vector<std::string>* remarks);

}  // namespace lobefit
