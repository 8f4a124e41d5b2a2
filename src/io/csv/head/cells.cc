#include "lobefit/io/csv/head/cells.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/base/text/csv_fields.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/lines.h"
#include "lobefit/io/text/place.h"
#include "lobefit/io/text/units.h"

namespace lobefit {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Characters of a number at the beginning of the text.
std::size_t LengthOfNumber(std::string_view text) {
  constexpr std::string_view kMinus = "\xe2\x88\x92";
  std::size_t at = 0;
  if (text.starts_with(kMinus)) {
    at = kMinus.size();
  } else if (!text.empty() && (text[0] == '+' || text[0] == '-')) {
    at = 1;
  }
  const std::size_t digits = at;
  while (at < text.size() && (IsDigit(text[at]) || text[at] == '.' || text[at] == ',')) ++at;
  if (std::none_of(text.begin() + static_cast<std::ptrdiff_t>(digits), text.begin() + static_cast<std::ptrdiff_t>(at),
                   IsDigit))
    return 0;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    std::size_t power = at + 1;
    if (power < text.size() && (text[power] == '+' || text[power] == '-')) ++power;
    const std::size_t first = power;
    while (power < text.size() && IsDigit(text[power])) ++power;
    if (power > first) at = power;
  }
  return at;
}

// A unit of anything that a column may hold, as PlainUnit gives it; nothing for other words.
std::optional<std::string> UnitOf(std::string_view text) {
  text = Trim(text);
  if (text.size() > 1 && text.front() == '[' && text.back() == ']') text = Trim(text.substr(1, text.size() - 2));
  if (text.empty()) return std::string();
  const std::string unit = PlainUnit(text);
  if (unit == "1") return std::nullopt;
  if (unit == "grad" || ParseAngleUnit(unit) || ParseValueScale(unit) || ParseWavelengthUnit(unit)) return unit;
  return std::nullopt;
}

// "12" behind "0.310" is 0.012: it counts the last digits.
double OfLastDigits(std::string_view number, char decimal_mark, double digits) {
  const std::size_t exponent = number.find_first_of("eE"), mark = number.substr(0, exponent).find(decimal_mark);
  const std::size_t end = std::min(exponent, number.size());
  const auto places = mark == std::string_view::npos ? 0 : static_cast<int>(end - mark - 1);
  return digits * std::pow(10.0, -places);
}

// "0.310(12)" and "3.10(12)e-1", from the bracket on.
std::optional<Cell> ParseConcise(std::string_view number, std::string_view rest, char decimal_mark) {
  const std::size_t close = rest.find(')');
  if (close == std::string_view::npos || close < 2) return std::nullopt;
  const std::string_view digits = rest.substr(1, close - 1);
  if (!std::all_of(digits.begin(), digits.end(), IsDigit)) return std::nullopt;
  rest.remove_prefix(close + 1);
  double power = 1;
  if (!rest.empty() && (rest[0] == 'e' || rest[0] == 'E')) {
    const std::size_t length = LengthOfNumber(rest.substr(1));
    const std::optional<double> exponent = ParseDouble(rest.substr(1, length));
    if (!exponent || length == 0) return std::nullopt;
    power = std::pow(10.0, *exponent);
    rest.remove_prefix(1 + length);
  }
  const std::optional<double> value = ParseCsvNumber(number, decimal_mark), last = ParseDouble(digits);
  const std::optional<std::string> unit = UnitOf(rest);
  if (!value || !last || !unit) return std::nullopt;
  return Cell{*value * power, OfLastDigits(number, decimal_mark, *last) * power, *unit};
}

// Takes one of the marks off the beginning.
template <std::size_t N>
bool TakeMark(const std::array<std::string_view, N>& marks, std::string_view* text) {
  for (const std::string_view mark : marks) {
    if (!text->starts_with(mark)) continue;
    *text = Trim(text->substr(mark.size()));
    return true;
  }
  return false;
}

// "10\u00b030'", "10d30m", "-10 deg 30' 15\"" from the degrees on.
std::optional<Cell> ParseMinutes(std::string_view number, std::string_view rest) {
  static constexpr std::array<std::string_view, 4> kDegrees = {"\xc2\xb0", "\xc2\xba", "deg", "d"};
  static constexpr std::array<std::string_view, 5> kMinutes = {"'", "\xe2\x80\xb2", "\xe2\x80\x99", "min", "m"};
  static constexpr std::array<std::string_view, 5> kSeconds = {"\"", "''", "\xe2\x80\xb3", "sec", "s"};
  const std::optional<double> degrees = ParseCsvNumber(number, '.');
  rest = Trim(rest);
  if (!degrees || *degrees != std::trunc(*degrees) || !TakeMark(kDegrees, &rest)) return std::nullopt;
  double parts = 0, unit = 1;
  for (const auto& marks : {kMinutes, kSeconds}) {
    const std::size_t length = LengthOfNumber(rest);
    if (length == 0) break;
    const std::optional<double> part = ParseDouble(rest.substr(0, length));
    rest = Trim(rest.substr(length));
    if (!part || !(*part >= 0 && *part < 60) || !TakeMark(marks, &rest)) return std::nullopt;
    unit /= 60;
    parts += *part * unit;
  }
  if (!rest.empty() || unit == 1) return std::nullopt;
  const bool negative = number.starts_with('-') || number.starts_with("\xe2\x88\x92");
  return Cell{*degrees + (negative ? -parts : parts), std::nullopt, "deg"};
}

}  // namespace

std::string_view NumberOfCell(std::string_view field) {
  std::string_view text = Trim(field);
  constexpr std::string_view kNoBreak = "\xc2\xa0";
  while (text.starts_with(kNoBreak)) text = Trim(text.substr(kNoBreak.size()));
  if (text.starts_with('(')) text = Trim(text.substr(1));
  const std::size_t length = LengthOfNumber(text);
  return length == 0 ? field : text.substr(0, length);
}

std::optional<Cell> ParseCell(std::string_view field, char decimal_mark) {
  std::string_view text = Trim(field);
  if (text.empty()) return std::nullopt;
  // "(0.31 ± 0.02) 1/sr"
  std::string_view outer;
  const bool bracketed = text.front() == '(';
  if (bracketed) {
    const std::size_t close = text.find(')');
    if (close == std::string_view::npos) return std::nullopt;
    outer = text.substr(close + 1);
    text = Trim(text.substr(1, close - 1));
  }
  const std::size_t length = LengthOfNumber(text);
  if (length == 0) return std::nullopt;
  const std::string_view number = text.substr(0, length);
  std::string_view rest = text.substr(length);
  if (!bracketed && rest.starts_with('(') && rest.size() > 1 && IsDigit(rest[1]))
    return ParseConcise(number, rest, decimal_mark);
  static constexpr std::array<std::string_view, 3> kSigns = {"\xc2\xb1", "+/-", "+-"};
  for (const std::string_view sign : kSigns) {
    const std::size_t at = rest.find(sign);
    if (at == std::string_view::npos) continue;
    const std::string_view behind = Trim(rest.substr(at + sign.size()));
    const std::size_t digits = LengthOfNumber(behind);
    const std::optional<std::string> own = UnitOf(rest.substr(0, at)), last = UnitOf(behind.substr(digits)),
                                     both = UnitOf(outer);
    const std::optional<double> value = ParseCsvNumber(number, decimal_mark),
                                spread = ParseCsvNumber(behind.substr(0, digits), decimal_mark);
    if (!own || !last || !both || !value || !spread || !(*spread >= 0)) return std::nullopt;
    // "31 ± 2 %" can be 2 % of 31 as well as 2 of 31 %.
    if (own->empty() && *last == "%") return std::nullopt;
    if (!own->empty() && !last->empty() && *own != *last) return std::nullopt;
    if (!both->empty() && !(own->empty() && last->empty())) return std::nullopt;
    return Cell{*value, *spread, !both->empty() ? *both : last->empty() ? *own : *last};
  }
  if (bracketed) return std::nullopt;
  if (const std::optional<Cell> angle = ParseMinutes(number, rest)) return angle;
  const std::optional<double> value = ParseCsvNumber(number, decimal_mark);
  const std::optional<std::string> unit = UnitOf(rest);
  if (!value || !unit) return std::nullopt;
  return Cell{*value, std::nullopt, *unit};
}

std::vector<CellForm> TakeCells(const InputFile& file, std::size_t line,
                                const std::vector<std::vector<std::string>>& first_rows, char decimal_mark,
                                std::vector<CsvColumn>* columns) {
  std::vector<CellForm> forms(columns->size());
  std::vector<bool> uncertain(columns->size(), false);
  bool any = false;
  for (const std::vector<std::string>& row : first_rows) {
    for (std::size_t i = 0; i < std::min(row.size(), forms.size()); ++i) {
      const ColumnRole role = (*columns)[i].role;
      if (role == ColumnRole::kUnknown || role == ColumnRole::kIgnored || role == ColumnRole::kPolarisation) continue;
      // The sign of degrees is passed over where numbers are read.
      if (ParseCsvNumber(row[i], decimal_mark) && !Trim(row[i]).ends_with("\xc2\xb0")) continue;
      const std::optional<Cell> cell = ParseCell(row[i], decimal_mark);
      if (!cell) continue;
      any = true;
      uncertain[i] = uncertain[i] || cell->uncertainty.has_value();
      if (cell->unit.empty()) continue;
      if (!forms[i].unit.empty() && forms[i].unit != cell->unit) {
        FailAtLine(file, line,
                   "the cells of the column " + QuotedName((*columns)[i]) + " are in '" + forms[i].unit + "' and in '" +
                       cell->unit + "'; give all in one unit");
      }
      const std::string_view text = Trim(row[i]), number = NumberOfCell(text);
      // Minutes are no unit that other cells end with.
      const bool whole = ParseCsvNumber(number, decimal_mark) == cell->number;
      if (forms[i].unit.empty() && !cell->uncertainty && text.starts_with(number) && whole)
        forms[i].suffix = std::string(text.substr(number.size()));
      forms[i].unit = cell->unit;
    }
  }
  if (!any) return {};
  for (std::size_t i = 0; i < forms.size(); ++i) {
    CsvColumn& column = (*columns)[i];
    if (forms[i].unit.empty()) continue;
    const bool of_wavelength = column.role == ColumnRole::kChannel && column.wavelength_nm > 0;
    if (!column.unit.empty() && !of_wavelength && PlainUnit(column.unit) != forms[i].unit &&
        !(IsPerSteradian(PlainUnit(column.unit)) && IsPerSteradian(forms[i].unit))) {
      FailAtLine(file, line,
                 "the column " + QuotedName(column) + " is in '" + Excerpt(column.unit) + "' by its name, but in '" +
                     forms[i].unit + "' by its cells; take one of them away");
    }
    SetUnit(forms[i].unit, &column);
  }
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const bool value = (*columns)[i].role == ColumnRole::kValue || (*columns)[i].role == ColumnRole::kChannel ||
                       (*columns)[i].role == ColumnRole::kOtherValue || (*columns)[i].role == ColumnRole::kFixed ||
                       (*columns)[i].role == ColumnRole::kNumber;
    if (!uncertain[i] || !value) continue;
    CsvColumn spread;
    spread.name = "uncertainty of " + (*columns)[i].name;
    spread.role = ColumnRole::kSigma;
    if ((*columns)[i].role == ColumnRole::kChannel) spread.channel = (*columns)[i].channel;
    forms[i].uncertainty = columns->size();
    columns->push_back(std::move(spread));
  }
  return forms;
}

}  // namespace lobefit
