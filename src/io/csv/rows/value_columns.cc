#include "lobefit/io/csv/rows/value_columns.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/value_mention.h"
#include "lobefit/io/csv/names/name_rules.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

bool HoldsValueWord(const CsvColumn& column) {
  const NameList words = SplitName(column.name).words;
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    std::optional<ValueKind> kind;
    return word.size() > 2 && NamesValue(word, &kind);
  });
}

}  // namespace

std::string SetRepetitionsAside(bool chosen, std::vector<CsvColumn>* columns) {
  std::vector<CsvColumn*> repetitions;
  bool light = false, viewer = false, mean = false;
  for (CsvColumn& column : *columns) {
    if (column.role == ColumnRole::kCoordinate) {
      light = light || column.coordinate == Coordinate::kThetaI;
      viewer = viewer || column.coordinate == Coordinate::kThetaO;
    }
    mean = mean || column.role == ColumnRole::kValue;
    const bool bare = column.name.find_first_not_of("+-.,0123456789 ") == std::string::npos;
    if (column.role == ColumnRole::kNumber && !bare) repetitions.push_back(&column);
  }
  if (!light || !viewer || repetitions.size() < 2) return "";
  for (std::size_t i = 0; i < repetitions.size(); ++i) {
    if (repetitions[i]->fixed != static_cast<double>(i + 1)) return "";
  }
  if (!mean && !chosen) {
    return "the columns " + QuotedName(*repetitions[0]) + " to " + QuotedName(*repetitions.back()) +
           " can be one sample measured again or several samples; choose one with --value-column \"" +
           Excerpt(repetitions[0]->name) + "\", or write the mean of repetitions into a column 'BRDF mean'";
  }
  for (CsvColumn* column : repetitions) column->role = ColumnRole::kIgnored;
  return "";
}

std::vector<std::string> TakeReflectances(bool kind_is_known, std::vector<CsvColumn>* columns) {
  static constexpr std::array<std::string_view, 8> kWords = {"r",           "rho",          "refl",       "ref",
                                                             "reflectance", "reflectivity", "reflektanz", "hcrf"};
  std::vector<std::string> names;
  for (CsvColumn& column : *columns) {
    if (column.role != ColumnRole::kUnknown) continue;
    NameList words = SplitName(column.name).words;
    if (words.size() == 1) {  // "R550"
      const std::size_t digit = words[0].find_first_of("0123456789");
      if (digit == std::string::npos || digit == 0) continue;
      words = {words[0].substr(0, digit), words[0].substr(digit)};
    }
    CsvColumn channel = ClassifyColumn(words.back());
    if (words.size() != 2 || !HoldsWord(kWords, words[0]) || channel.role != ColumnRole::kChannel ||
        !(channel.wavelength_nm > 0))
      continue;
    names.push_back(Excerpt(column.name));
    if (!kind_is_known) continue;
    channel.name = std::move(column.name);
    column = std::move(channel);
  }
  return names;
}

bool TakeOnlyNamed(std::vector<CsvColumn>* columns) {
  CsvColumn* only = nullptr;
  for (CsvColumn& column : *columns) {
    if (column.role != ColumnRole::kUnknown || !HoldsValueWord(column)) continue;
    if (only != nullptr) return false;  // "BRDF_raw" beside "BRDF_corrected"
    only = &column;
  }
  // What stands in brackets or is a formula is not passed over.
  if (only == nullptr || only->name.find_first_of("()[]{}<>/*^%|=+0123456789") != std::string::npos ||
      !KindNamedIn(only->name))
    return false;
  only->role = ColumnRole::kValue;
  only->value_kind = KindNamedIn(only->name);
  const std::string unit = std::exchange(only->unit, {});
  SetUnit(unit, only);
  return true;
}

std::vector<std::string> FindUnknownNumbers(const CsvHeader& header, const std::vector<CsvColumn>& columns) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const bool number = !header.first_rows.empty() && i < header.first_rows[0].size() &&
                        ParseCsvNumber(header.first_rows[0][i], header.decimal_mark);
    if (columns[i].role == ColumnRole::kUnknown && number && !columns[i].name.empty())
      names.push_back(Excerpt(columns[i].name));
  }
  return names;
}

}  // namespace lobefit
