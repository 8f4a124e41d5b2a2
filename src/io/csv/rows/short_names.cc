#include "lobefit/io/csv/rows/short_names.h"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "lobefit/io/csv/names/name_rules.h"

namespace lobefit {
namespace {

using C = Coordinate;

NameList WordsOf(const CsvColumn& column) { return SplitName(column.name).words; }

void Become(C coordinate, CsvColumn* column) {
  column->role = ColumnRole::kCoordinate;
  column->coordinate = coordinate;
}

// Only names that begin like the first word and are hardly longer are taken apart: a table may have 65 536 columns.
CsvColumn* Find(std::vector<CsvColumn>* columns, const NameList& words) {
  constexpr std::size_t kUnit = 12;
  const std::size_t longest = Joined(words).size() + kUnit;
  const auto found = std::find_if(columns->begin(), columns->end(), [&](const CsvColumn& column) {
    return !column.name.empty() && column.name.size() <= longest && (column.name[0] | 0x20) == words[0][0] &&
           WordsOf(column) == words;
  });
  return found == columns->end() ? nullptr : &*found;
}

bool Has(const std::vector<CsvColumn>& columns, std::initializer_list<C> any) {
  return std::any_of(columns.begin(), columns.end(), [&](const CsvColumn& column) {
    return column.role == ColumnRole::kCoordinate && std::find(any.begin(), any.end(), column.coordinate) != any.end();
  });
}

void NameZeniths(std::vector<CsvColumn>* columns) {
  for (CsvColumn& zenith : *columns) {
    const std::string_view name = zenith.name;
    if (name.empty() || (name.back() != 'z' && name.back() != 'Z')) continue;
    const NameList own = WordsOf(zenith);
    if (own.size() != 2 || own[1] != "z" || !(IsLightWord(own[0]) || IsViewerWord(own[0]))) continue;
    CsvColumn* azimuth = Find(columns, {own[0], "a"});
    if (azimuth == nullptr) azimuth = Find(columns, {own[0], "az"});
    if (azimuth == nullptr || Find(columns, {own[0], "x"}) != nullptr) continue;
    const bool light = IsLightWord(own[0]);
    Become(light ? C::kThetaI : C::kThetaO, &zenith);
    Become(light ? C::kPhiI : C::kPhiO, azimuth);
  }
}

void NamePlanetary(std::vector<CsvColumn>* columns) {
  CsvColumn* in = Find(columns, {"i"});
  CsvColumn* out = in == nullptr ? nullptr : Find(columns, {"e"});
  if (out == nullptr || in->role != ColumnRole::kUnknown || out->role != ColumnRole::kUnknown) return;
  CsvColumn* phase = Find(columns, {"g"});
  if (phase == nullptr) phase = Find(columns, {"alpha"});
  CsvColumn* azimuth = Find(columns, {"psi"});
  if (phase == nullptr && azimuth == nullptr && !Has(*columns, {C::kPhi, C::kPhase, C::kDeltaPhi})) return;
  Become(C::kThetaI, in);
  Become(C::kThetaO, out);
  if (phase != nullptr) Become(C::kPhase, phase);
  if (azimuth != nullptr) Become(C::kPhi, azimuth);
}

}  // namespace

void NameShortAngles(std::vector<CsvColumn>* columns) {
  NameZeniths(columns);
  NamePlanetary(columns);
}

}  // namespace lobefit
