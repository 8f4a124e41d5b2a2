#include "lobefit/io/csv/head/row_conditions.h"

#include <string_view>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {

std::vector<RowCondition> ParseRowConditions(const std::string& text) {
  std::vector<RowCondition> conditions;
  for (const std::string_view item : Split(text, ',')) {
    const std::size_t at = item.find('=');
    if (at == std::string_view::npos || Trim(item.substr(0, at)).empty()) {
      throw UsageError("--where " + Excerpt(text, 100) + ": '" + Excerpt(Trim(item)) +
                       "' is not COLUMN=VALUE; write it as in pol=s");
    }
    conditions.push_back({std::string(Trim(item.substr(0, at))), ToLower(Trim(item.substr(at + 1)))});
  }
  return conditions;
}

}  // namespace lobefit
