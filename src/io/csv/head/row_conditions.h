// --where: which rows of a CSV are read.
#pragma once

#include <string>
#include <vector>

namespace lobefit {

// Rows whose field in `column` (a name, or a number as in "#3") is `word`, case aside.
struct RowCondition {
  std::string column, word;
};

// "pol=s,scan=2". Throws UsageError for an item that is not COLUMN=VALUE.
std::vector<RowCondition> ParseRowConditions(const std::string& text);

}  // namespace lobefit
