// Columns of values that are those of two polarisations, or of two before and two behind the sample.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/io/csv/names/columns.h"

namespace lobefit {

// "BRDF_s,BRDF_p", "s-BRDF,p-BRDF", "BRDF (s-pol),BRDF (p-pol)", "f_TE,f_TM", "BRDF_ss,BRDF_sp,BRDF_ps,BRDF_pp".
struct PolarisedColumns {
  std::vector<std::size_t> columns;
  std::vector<std::string> states;      // "s", one a column
  std::optional<ValueKind> value_kind;  // of all of them, by their name
  // Where a column holds their mean ("BRDF_avg"), that is f_r of unpolarised light, and the others are not needed.
  bool mean_is_given = false;
};

// Empty where no complete set of them stands among the columns.
PolarisedColumns FindPolarisedColumns(const std::vector<CsvColumn>& columns);

}  // namespace lobefit
