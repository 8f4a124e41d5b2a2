#include "lobefit/io/csv/head/column_units.h"

#include <algorithm>
#include <array>
#include <optional>

#include "lobefit/base/text/text.h"
#include "lobefit/io/text/units.h"

namespace lobefit {
namespace {

bool HasNumber(std::string_view text) { return text.find_first_of("0123456789") != std::string_view::npos; }

// A unit that columns of this role may have; empty for other words.
std::string UnitOfRole(std::string_view text, ColumnRole role) {
  text = Trim(text);
  while (text.ends_with('.') || text.ends_with(',')) text = Trim(text.substr(0, text.size() - 1));
  if (text.size() > 2 && (text.front() == '(' || text.front() == '[') && (text.back() == ')' || text.back() == ']'))
    text = Trim(text.substr(1, text.size() - 2));
  const std::string unit = PlainUnit(text);
  if (unit.empty() || unit == "-" || ParseDouble(unit)) return "";
  const bool known = role == ColumnRole::kCoordinate   ? ParseAngleUnit(unit).has_value()
                     : role == ColumnRole::kWavelength ? ParseWavelengthUnit(unit).has_value()
                                                       : ParseValueScale(unit).has_value();
  return known ? unit : "";
}

constexpr std::array kRolesWithUnits = {ColumnRole::kCoordinate, ColumnRole::kValue, ColumnRole::kWavelength};
bool HasUnits(ColumnRole role) {
  return std::find(kRolesWithUnits.begin(), kRolesWithUnits.end(), role) != kRolesWithUnits.end();
}

// "rad", "incidence angle [rad]", "the angle of the light, in radians".
std::string UnitAtEnd(std::string_view text, ColumnRole role) {
  text = Trim(text);
  if (text.starts_with("in ")) text.remove_prefix(3);
  if (std::string whole = UnitOfRole(text, role); !whole.empty()) return whole;
  for (const std::string_view mark : {"[", "(", " in ", ", "}) {
    const std::size_t at = text.rfind(mark);
    if (at == std::string_view::npos || HasNumber(text.substr(0, at))) continue;
    const std::size_t begin = mark == "[" || mark == "(" ? at : at + mark.size();
    if (std::string unit = UnitOfRole(text.substr(begin), role); !unit.empty()) return unit;
  }
  return "";
}

// Of some column; what has none is not looked at further: a name takes ten times as long, and a file may have a hundred
// thousand lines of comments.
bool HasUnitAtEnd(std::string_view text) {
  return std::any_of(kRolesWithUnits.begin(), kRolesWithUnits.end(),
                     [&](ColumnRole role) { return !UnitAtEnd(text, role).empty(); });
}

// "Column 3", "col. 3", "C3", "3".
bool IsColumnNumber(std::string_view text) {
  const std::string lower = ToLower(Trim(text));
  const std::size_t digits = lower.find_first_of("0123456789");
  if (digits == std::string::npos || lower.find_first_not_of("0123456789", digits) != std::string::npos) return false;
  static constexpr std::array<std::string_view, 7> kWords = {"", "column", "col", "col.", "c", "field", "spalte"};
  return std::find(kWords.begin(), kWords.end(), Trim(std::string_view(lower).substr(0, digits))) != kWords.end();
}

// The text behind `name` up to the next comma or bracket: of a column in a table of Astropy's ECSV.
std::string_view Member(std::string_view text, std::string_view name) {
  const std::size_t at = text.find(name);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + name.size());
  return Trim(text.substr(0, text.find_first_of(",}")));
}

// One name with its unit, perhaps with words behind: "theta_i (rad) - incidence".
void AddNamed(std::string_view name, std::vector<ColumnUnit>* found) {
  for (const std::string_view text : {name, name.substr(0, name.find(" - ")), name.substr(0, name.find(','))}) {
    if (!HasUnitAtEnd(text)) continue;
    const CsvColumn column = ClassifyColumn(text);
    if (!HasUnits(column.role) || column.unit.empty()) continue;
    found->push_back({std::string(Trim(text)), column.unit});
    return;
  }
}

// "theta_i, theta_o: rad"
void AddList(std::string_view part, std::size_t mark, std::vector<ColumnUnit>* found) {
  if (!HasUnitAtEnd(part.substr(mark + 1))) return;
  std::vector<ColumnUnit> all;
  for (const std::string_view name : Split(part.substr(0, mark), ',')) {
    const CsvColumn column = ClassifyColumn(name);
    if (!HasUnits(column.role) || !column.unit.empty()) return;
    const std::string unit = UnitAtEnd(part.substr(mark + 1), column.role);
    if (unit.empty()) return;
    all.push_back({std::string(Trim(name)), unit});
  }
  found->insert(found->end(), all.begin(), all.end());
}

// `known`: the statement's column as a name.
bool IsColumn(const ColumnUnit& unit, const CsvColumn& known, const CsvColumn& column) {
  if (ToLower(column.name) == ToLower(unit.column)) return true;
  return known.role == column.role &&
         ((known.role == ColumnRole::kCoordinate && known.coordinate == column.coordinate) ||
          known.role == ColumnRole::kValue);
}

// Whether numbers in the stated unit are others than the column's; `angles`: of columns that have no unit.
bool IsReadOtherwise(std::string_view unit, const CsvColumn& column, AngleUnit angles) {
  if (column.role == ColumnRole::kCoordinate) {
    const std::optional<AngleUnit> angle = ParseAngleUnit(unit);
    return angle && *angle != column.angle_unit.value_or(angles);
  }
  if (column.role != ColumnRole::kValue) return false;
  const ValueScale own = column.value_scale.value_or(ValueScale());
  const std::optional<ValueScale> scale = ParseValueScale(unit);
  return scale && (scale->form != own.form || scale->factor != own.factor);
}

}  // namespace

std::vector<ColumnUnit> FindColumnUnits(std::string_view text) {
  constexpr std::size_t kMost = 400;  // longer is a text
  std::vector<ColumnUnit> found;
  text = Trim(text);
  if (text.size() > kMost) return found;
  if (text.starts_with("- {name:")) {
    const std::string_view unit = Member(text, "unit:");
    if (!unit.empty()) found.push_back({std::string(Member(text, "name:")), PlainUnit(unit)});
    return found;
  }
  for (const std::string_view part : Split(text, ';')) {
    const std::size_t mark = part.find_first_of(":=");
    if (mark == std::string_view::npos) {
      AddNamed(Trim(part), &found);
    } else if (IsColumnNumber(part.substr(0, mark))) {
      AddNamed(Trim(part.substr(mark + 1)), &found);
    } else {
      AddList(part, mark, &found);
    }
  }
  return found;
}

const ColumnUnit* SetColumnUnits(const std::vector<ColumnUnit>& stated, std::vector<CsvColumn>* columns) {
  for (const ColumnUnit& unit : stated) {
    const CsvColumn known = ClassifyColumn(unit.column);
    for (CsvColumn& column : *columns) {
      if (!IsColumn(unit, known, column)) continue;
      if (column.unit.empty()) {
        SetUnit(unit.unit, &column);
      } else if (IsReadOtherwise(unit.unit, column, AngleUnit::kDegrees)) {
        return &unit;
      }
    }
  }
  return nullptr;
}

bool KeepsUnits(const ColumnUnit& stated, const std::vector<CsvColumn>& columns, AngleUnit angles) {
  const CsvColumn known = ClassifyColumn(stated.column);
  return std::none_of(columns.begin(), columns.end(), [&](const CsvColumn& column) {
    return IsColumn(stated, known, column) && IsReadOtherwise(stated.unit, column, angles);
  });
}

}  // namespace lobefit
