// Which columns hold the uncertainties of which values.
#pragma once

#include <vector>

#include "lobefit/io/csv/rows/layout.h"

namespace lobefit {

// Gives the groups of `layout`, its channels or all of them the columns of their uncertainties: those of the names,
// those behind each value in a table with a column for each angle, or those that stand for uncertainties within cells.
// Throws InputError where some lack one, or where weights are given too.
void FindUncertainties(const InputFile& file, const CsvHeader& header, const std::vector<CsvColumn>& columns,
                       CsvLayout* layout, Measurement* notes);

// One group of values for each of several tables that stand side by side, after the layout of the first. Throws
// InputError for what such tables are not read with.
void SpreadSideTables(const InputFile& file, const CsvHeader& header, CsvLayout* layout);

}  // namespace lobefit
