// Both angles in one word, as instruments for colour write them.
#pragma once

#include <string>
#include <vector>

#include "lobefit/io/csv/names/columns.h"

namespace lobefit {

// What to do about "45:0" or "45/0" among the names, those and "45as15" in the first row; empty where there is
// none.
std::string DescribeGeometries(const std::vector<CsvColumn>& columns,
                               const std::vector<std::vector<std::string>>& first_rows);

}  // namespace lobefit
