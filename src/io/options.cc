#include "lobefit/io/options.h"

#include <array>

#include "lobefit/base/text.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

template <class Value>
struct Word {
  std::string_view word;
  Value value;
};

// The first word of each value is its name.
constexpr std::array<Word<AngleUnit>, 4> kAngleUnits = {{{"deg", AngleUnit::kDegrees},
                                                         {"degrees", AngleUnit::kDegrees},
                                                         {"rad", AngleUnit::kRadians},
                                                         {"radians", AngleUnit::kRadians}}};
constexpr std::array<Word<ValueKind>, 6> kValueKinds = {{{"f", ValueKind::kBrdf},
                                                         {"f-cos-o", ValueKind::kBrdfCosO},
                                                         {"f-cos-i", ValueKind::kBrdfCosI},
                                                         {"pi-f", ValueKind::kReflectanceFactor},
                                                         {"intensity", ValueKind::kIntensity},
                                                         {"pi-f-cos-o", ValueKind::kReading}}};
constexpr std::array<Word<IncidentSense>, 2> kSenses = {
    {{"towards", IncidentSense::kTowardsSource}, {"propagation", IncidentSense::kPropagation}}};
constexpr std::array<Word<CellPosition>, 3> kPositions = {
    {{"centre", CellPosition::kCentre}, {"center", CellPosition::kCentre}, {"edge", CellPosition::kEdge}}};

template <class Table>
auto Find(const Table& table, std::string_view word) -> std::optional<decltype(table[0].value)> {
  const std::string lower = ToLower(Trim(word));
  for (const auto& entry : table) {
    if (entry.word == lower) return entry.value;
  }
  return std::nullopt;
}

template <class Table, class Value>
std::string NameIn(const Table& table, Value value) {
  for (const auto& entry : table) {
    if (entry.value == value) return std::string(entry.word);
  }
  return "";
}

}  // namespace

std::optional<AngleUnit> ParseAngleUnit(std::string_view word) { return Find(kAngleUnits, word); }
std::optional<ValueKind> ParseValueKind(std::string_view word) { return Find(kValueKinds, word); }
std::optional<IncidentSense> ParseIncidentSense(std::string_view word) { return Find(kSenses, word); }
std::optional<CellPosition> ParseCellPosition(std::string_view word) { return Find(kPositions, word); }

std::string AllowedValueKinds() {
  std::vector<std::string> words;
  for (const auto& entry : kValueKinds) words.emplace_back(entry.word);
  return Join(words);
}

std::string Name(AngleUnit unit) { return NameIn(kAngleUnits, unit); }
std::string Name(ValueKind kind) { return NameIn(kValueKinds, kind); }
std::string Name(IncidentSense sense) { return NameIn(kSenses, sense); }
std::string Name(CellPosition position) { return NameIn(kPositions, position); }

double BrdfFactor(ValueKind kind, double cos_theta_i, double cos_theta_o) {
  const double per_cos_o = cos_theta_o > 0 ? 1 / cos_theta_o : 1;
  switch (kind) {
    case ValueKind::kBrdf:
      return 1;
    case ValueKind::kBrdfCosO:
    case ValueKind::kIntensity:
      return per_cos_o;
    case ValueKind::kBrdfCosI:
      return cos_theta_i > 0 ? 1 / cos_theta_i : 1;
    case ValueKind::kReflectanceFactor:
      return kInvPi;
    case ValueKind::kReading:
      return kInvPi * per_cos_o;
  }
  return 1;
}

}  // namespace lobefit
