// Tables that stand side by side in one sheet: "AOI 10,,AOI 30,," over "theta_s,BRDF,theta_s,BRDF".
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "lobefit/io/csv/head/keys.h"
#include "lobefit/io/csv/names/columns.h"

namespace lobefit {

// One of them.
struct SideTable {
  std::vector<std::size_t> columns;      // in the order of the first table's
  std::optional<FixedCoordinate> fixed;  // what its heading says: "AOI 10"
};

// Tables of two columns or more with the same meanings in the same order, empty columns between them aside; nothing
// where the columns are not such, or where only some headings say an angle, or another one than the first. The columns
// of all but the first become ones that are not used by themselves. `headings` are the cells above the names of the
// `written_columns`.
std::vector<SideTable> FindSideTables(const std::vector<std::string_view>& headings, std::size_t written_columns,
                                      std::vector<CsvColumn>* columns);

}  // namespace lobefit
