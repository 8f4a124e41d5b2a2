#include "lobefit/io/csv/names/polarised_columns.h"

#include <algorithm>
#include <array>

#include "lobefit/io/csv/names/name_rules.h"
#include "lobefit/measurement/prepare/polarisation.h"

namespace lobefit {
namespace {

// "BRDF (s-pol)", "s-polarised BRDF"
bool IsPolarisationWord(std::string_view word) {
  static constexpr std::array<std::string_view, 6> kWords = {"pol",          "polarised",    "polarized",
                                                             "polarisation", "polarization", "polarisiert"};
  return HoldsWord(kWords, word);
}

}  // namespace

PolarisedColumns FindPolarisedColumns(const std::vector<CsvColumn>& columns) {
  static const std::array<std::vector<std::string>, 5> kSets = {
      {{"ss", "sp", "ps", "pp"}, {"s", "p"}, {"te", "tm"}, {"perpendicular", "parallel"}, {"senkrecht", "parallel"}}};
  std::vector<NameList> names;
  for (const CsvColumn& column : columns) {
    std::optional<ValueKind> kind;
    NameList words = SplitName(column.name).words;
    std::erase_if(words, IsPolarisationWord);
    if (words.size() == 2 && !NamesValue(words[0], &kind)) std::swap(words[0], words[1]);
    const bool value = column.role != ColumnRole::kCoordinate && words.size() == 2 && NamesValue(words[0], &kind);
    names.push_back(value ? std::move(words) : NameList());
  }
  for (const std::vector<std::string>& states : kSets) {
    for (const NameList& first : names) {
      if (first.empty() || first[1] != states[0]) continue;
      PolarisedColumns found;
      NamesValue(first[0], &found.value_kind);
      for (const std::string& state : states) {
        const auto at = std::find(names.begin(), names.end(), NameList{first[0], state});
        if (at == names.end()) break;
        found.columns.push_back(static_cast<std::size_t>(at - names.begin()));
        found.states.push_back(state);
      }
      if (found.columns.size() < states.size()) continue;
      found.mean_is_given = std::any_of(names.begin(), names.end(), [&](const NameList& other) {
        return !other.empty() && other[0] == first[0] && other[1].size() > 1 && IsUnpolarised(other[1]);
      });
      return found;
    }
  }
  return {};
}

}  // namespace lobefit
