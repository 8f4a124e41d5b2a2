#include "lobefit/io/csv/rows/distinctions.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "lobefit/base/text/csv_fields.h"
#include "lobefit/base/text/text.h"

namespace lobefit {

std::string DescribeDistinctions(const InputFile& file, const CsvHeader& header, const CsvLayout& layout) {
  constexpr std::size_t kRows = 20000, kMostValues = 6;
  if (layout.unused.empty()) return "";
  std::map<std::string, std::vector<std::string>, std::less<>> first_of_directions;
  std::vector<std::vector<std::string>> values(layout.unused.size());
  std::vector<bool> differs(layout.unused.size(), false);
  CsvLines lines(file.bytes);
  std::string_view line;
  std::vector<std::string_view> fields;
  std::string storage, key;
  for (std::size_t rows = 0; rows < kRows && lines.Next(&line);) {
    if (lines.line_number() < header.first_data_line || Trim(line).empty() || IsComment(line)) continue;
    SplitCsvLine(line, header.separator, &fields);
    if (fields.size() < header.written_columns) continue;
    ++rows;
    key.clear();
    for (const auto& [coordinate, column] : layout.coordinates) {
      key += Trim(fields[column]);
      key += ';';
    }
    if (layout.wavelength != kNoColumn) key += Trim(fields[layout.wavelength]);
    std::vector<std::string> own;
    for (const std::size_t column : layout.unused) own.emplace_back(Unquoted(fields[column], &storage));
    for (std::size_t c = 0; c < own.size(); ++c) {
      if (values[c].size() <= kMostValues && std::find(values[c].begin(), values[c].end(), own[c]) == values[c].end())
        values[c].push_back(own[c]);
    }
    const auto [known, is_new] = first_of_directions.try_emplace(key, own);
    if (is_new) continue;
    for (std::size_t c = 0; c < own.size(); ++c) differs[c] = differs[c] || known->second[c] != own[c];
  }
  std::string remark;
  for (std::size_t c = 0; c < layout.unused.size(); ++c) {
    if (!differs[c]) continue;
    const std::string name = Excerpt(header.columns[layout.unused[c]].name);
    std::vector<std::string> some;
    for (const std::string& value : values[c]) some.push_back(Excerpt(value, 20));
    const bool more = some.size() > kMostValues;
    if (more) some.resize(kMostValues);
    remark += (remark.empty() ? "rows of the same directions differ in '" : " and in '") + name + "' (" + Join(some) +
              (more ? ", ..." : "") + ")";
    if (remark.size() > 300) break;
  }
  if (remark.empty()) return "";
  std::size_t first = 0;
  while (!differs[first]) ++first;
  const std::string name = Excerpt(header.columns[layout.unused[first]].name);
  return remark + ": the first of them is kept; choose with --where \"" + name + "=" + Excerpt(values[first][0], 20) +
         "\", or average with --repeated mean; a wavelength is named by --columns \"wavelength=" + name + "\"";
}

}  // namespace lobefit
