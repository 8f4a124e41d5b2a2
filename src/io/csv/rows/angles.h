// Which columns give the directions: what names leave open is decided by the other names, or asked for.
#pragma once

#include <string>
#include <vector>

#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/rows/layout.h"

namespace lobefit {

// Fills directions, coordinates and fixed of the layout. `columns` are those of the header; what each turned out to be
// is written back. Names of columns that say the same again go to `unused`. Throws InputError.
void FindAngles(const InputFile& file, const CsvHeader& header, const ReadOptions& options,
                std::vector<CsvColumn>* columns, CsvLayout* layout, Measurement* notes);

}  // namespace lobefit
