#include "lobefit/io/csv/rows/geometries.h"

#include <algorithm>
#include <string_view>

#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

bool IsGeometry(std::string_view text) {
  std::string word = ToLower(Trim(text));
  for (const std::string_view degree : {"\u00b0", "deg", " "}) {
    for (std::size_t at = word.find(degree); at != std::string::npos; at = word.find(degree))
      word.erase(at, degree.size());
  }
  if (word.starts_with('r')) word.erase(0, 1);
  for (const std::string_view mark : {"as", ":", "/"}) {
    const std::size_t at = word.find(mark);
    if (at == std::string::npos) continue;
    const std::string_view all = word;
    return ParseDouble(all.substr(0, at)) && ParseDouble(all.substr(at + mark.size()));
  }
  return false;
}

}  // namespace

std::string DescribeGeometries(const std::vector<CsvColumn>& columns,
                               const std::vector<std::vector<std::string>>& first_rows) {
  std::vector<std::string> words;
  for (const CsvColumn& column : columns) words.push_back(column.name);
  if (!first_rows.empty()) words.insert(words.end(), first_rows[0].begin(), first_rows[0].end());
  const auto found = std::find_if(words.begin(), words.end(), IsGeometry);
  if (found == words.end()) return "";
  const bool aspecular = ToLower(*found).find("as") != std::string::npos;
  return "'" + Excerpt(*found) + "' holds two angles in one word; write one row a value with a column for each: " +
         (aspecular ? "AOI and aspecular (45as15 is AOI 45, aspecular 15), and the values, as 'reflectance factor (%)'"
                    : "theta_i and theta_o (45:0 is theta_i 45, theta_o 0), and the values");
}

}  // namespace lobefit
