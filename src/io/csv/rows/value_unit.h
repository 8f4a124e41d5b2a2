// What the values of a goniometer's CSV are, and in what unit: by option, head or the name of their column.
#pragma once

#include <vector>

#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/rows/layout.h"

namespace lobefit {

// Fills value_kind and value_scale of the layout, whose groups are known. Throws InputError for columns of different
// units, UsageError for a unit that is unknown.
void FindValueUnit(const InputFile& file, const CsvHeader& header, const ReadOptions& options,
                   const std::vector<CsvColumn>& columns, CsvLayout* layout, Measurement* notes);

}  // namespace lobefit
