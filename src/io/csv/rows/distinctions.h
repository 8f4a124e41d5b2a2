// Where the same directions occur again: the column of unknown meaning that tells those rows apart, if there is one.
#pragma once

#include <string>

#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/rows/layout.h"

namespace lobefit {

// A remark such as "rows of the same directions differ in 'run' (1, 2, 3): ..."; empty where no column does. Looks at
// the first 20 000 rows.
std::string DescribeDistinctions(const InputFile& file, const CsvHeader& header, const CsvLayout& layout);

}  // namespace lobefit
