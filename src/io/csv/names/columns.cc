#include "lobefit/io/csv/names/columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/names/name_rules.h"

namespace lobefit {
namespace {

// "pol", "source polarization", "analyzer angle (deg)": what tells rows of the same directions apart.
bool ClassifyPolarisation(const NameList& words, CsvColumn* column) {
  static constexpr std::array<std::string_view, 11> kPolarisation = {"pol",
                                                                     "polarization",
                                                                     "polarisation",
                                                                     "polarizer",
                                                                     "polariser",
                                                                     "analyzer",
                                                                     "analyser",
                                                                     "polarizacion",
                                                                     "polarizzazione",
                                                                     "polarizacao",
                                                                     "polarisationsrichtung"};
  static constexpr std::array<std::string_view, 12> kBeside = {"state", "angle",    "orientation", "direction",
                                                               "plane", "position", "setting",     "axis",
                                                               "type",  "of",       "the",         "config"};
  bool polarisation = false, viewer = false, value = false;
  for (const std::string_view word : words) {
    const bool names_it = HoldsWord(kPolarisation, word);
    polarisation = polarisation || names_it;
    viewer = viewer || word == "analyzer" || word == "analyser" || IsViewerWord(word);
    value = value || !(names_it || HoldsWord(kBeside, word) || IsViewerWord(word) || IsLightWord(word));
  }
  if (!polarisation || value) return false;
  column->role = ColumnRole::kPolarisation;
  column->of_viewer = viewer;
  return true;
}

// "45as15", "r45as-15": light at 45 degrees, seen 15 degrees from its mirror direction towards it.
bool ClassifyGeometry(std::string_view name, CsvColumn* column) {
  name = Trim(name);
  if (name.starts_with('r') || name.starts_with('R')) name.remove_prefix(1);
  const std::size_t at = name.find("as");
  if (name.empty() || at == 0 || at > 3 || name.size() > 8 || at == std::string_view::npos) return false;
  const std::optional<double> incidence = ParseDouble(name.substr(0, at)), offset = ParseDouble(name.substr(at + 2));
  if (!incidence || !offset || !(*incidence >= 0 && *incidence < 90) || !(std::fabs(*offset) < 180)) return false;
  column->role = ColumnRole::kFixed;
  column->coordinate = Coordinate::kFromSpecular;
  column->fixed = *offset;
  column->fixed_incidence = incidence;
  column->angle_unit = AngleUnit::kDegrees;
  column->reversed = true;
  return true;
}

bool IsValueWord(const std::string& word) {
  std::optional<ValueKind> kind;
  return NamesValue(word, &kind);
}

// Ratios of Mueller matrix elements beside f_r11, as in "f_r12/f_r11": the polarised part, which f_r does not need.
bool IsMuellerRatio(const NameList& words) {
  return words.size() == 4 && words[0] == "f" && words[2] == "f" && words[3] == "r11" && words[1].size() == 3 &&
         words[1][0] == 'r';
}

enum class Fixed : std::uint8_t { kTried, kNot };

// Kept from trying ClassifyFixed on what is left when it took a number: its answer would be none, and names of a dozen
// numbers took most of the time of reading a head.
CsvColumn ClassifyName(std::string_view name, Fixed fixed);

}  // namespace

bool ClassifyFixed(const NameList& words, CsvColumn* column) {
  const auto has_digit = [](const std::string& word) { return word.find_first_of("0123456789") != std::string::npos; };
  if (std::none_of(words.begin(), words.end(), has_digit)) return false;
  std::optional<double> number;
  NameList rest;
  std::string unit = column->unit;
  for (const std::string& word : words) {
    std::size_t digits = word.size();
    while (digits > 0 && !(word[digits - 1] >= '0' && word[digits - 1] <= '9')) --digits;
    const std::string tail = word.substr(digits);
    if (!number && digits > 0 && ParseDouble(word.substr(0, digits)) && (tail.empty() || ParseAngleUnit(tail)) &&
        word.substr(0, digits).find('e') == std::string::npos) {
      number = ParseDouble(word.substr(0, digits));
      if (!tail.empty()) unit = tail;
    } else if (!(ParseAngleUnit(word) && word != "deg") && word != "deg" && word != "at" && !IsValueWord(word)) {
      rest.push_back(word);
    } else if (ParseAngleUnit(word)) {
      unit = word;
    }
  }
  if (!number || !std::isfinite(*number)) return false;
  column->fixed = *number;
  column->unit = unit;
  if (rest.empty()) {
    column->role = ColumnRole::kNumber;
    column->angle_unit = ParseAngleUnit(unit);
    return true;
  }
  // "i=10" of planetary work and of tables of lighting.
  const bool letter = rest.size() == 1 && rest[0] == "i" && column->name.find('=') != std::string::npos;
  const CsvColumn left = ClassifyName(letter ? "theta_i" : Joined(rest), Fixed::kNot);
  if (left.role != ColumnRole::kCoordinate) return false;
  column->role = ColumnRole::kFixed;
  column->coordinate = left.coordinate;
  column->form = left.form;
  column->letter_s = left.letter_s;
  column->angle_unit = ParseAngleUnit(unit);
  return true;
}

namespace {

// "BRDF x 1000", "100*BRDF", "BRDF*1e3 (1/sr)": what a column holds the multiple of, and the factor.
struct Product {
  std::string of;
  double factor = 1;
};
std::optional<Product> FindProduct(std::string_view name) {
  for (const std::string_view mark : {std::string_view("*"), std::string_view("\u00d7"), std::string_view(" x ")}) {
    const std::size_t at = name.find(mark);
    if (at == std::string_view::npos || name.find(mark, at + mark.size()) != std::string_view::npos) continue;
    const std::string_view left = Trim(name.substr(0, at)), right = Trim(name.substr(at + mark.size()));
    for (const auto& [number, value] : {std::pair(left, right), std::pair(right, left)}) {
      const std::size_t end = std::min(number.find_first_not_of("0123456789.eE+-^"), number.size());
      const std::string_view rest = Trim(number.substr(end));
      const bool power = number.starts_with("10^");
      const std::optional<double> digits = ParseDouble(number.substr(power ? 3 : 0, end - (power ? 3 : 0)));
      if (!digits || !(rest.empty() || rest.starts_with('(') || rest.starts_with('['))) continue;
      // "10*log10(BRDF)" is a function.
      const std::string lower = ToLower(value);
      if (lower.empty() || lower.starts_with("log") || lower.starts_with("lg") || lower.starts_with("ln")) continue;
      const double factor = power ? std::pow(10.0, *digits) : *digits;
      if (factor > 0 && std::isfinite(factor)) return Product{std::string(value) + " " + std::string(rest), factor};
    }
  }
  return std::nullopt;
}

// The column that holds `factor` times what `column` would.
CsvColumn Multiplied(CsvColumn column, std::string_view name, double factor) {
  column.name = std::string(Trim(name));
  ValueScale scale = column.value_scale.value_or(ValueScale());
  if (scale.form != ValueScale::Form::kLinear || scale.factor != 1) {
    column.problem = "has a factor in its name and a scale in its unit; say by --value-scale what its numbers are in";
    return column;
  }
  scale.factor = 1 / factor;
  column.value_scale = scale;
  return column;
}

CsvColumn ClassifyName(std::string_view name, Fixed fixed) {
  if (const std::optional<Product> product = FindProduct(name)) {
    CsvColumn of = ClassifyName(product->of, fixed);
    if (of.role == ColumnRole::kValue || of.role == ColumnRole::kOtherValue || of.role == ColumnRole::kChannel)
      return Multiplied(std::move(of), name, product->factor);
  }
  CsvColumn column;
  column.name = std::string(Trim(name));
  if (ClassifyGeometry(name, &column)) return column;
  NameWords split = SplitName(name);
  if (split.words.size() > 12) return column;
  column.unit = split.unit;
  column.foreign = split.foreign;
  // A unit amid the words: "theta (deg) incident".
  if (column.unit.empty()) {
    const auto unit = std::find_if(split.words.begin(), split.words.end(),
                                   [](const std::string& word) { return ParseAngleUnit(word).has_value(); });
    if (unit != split.words.end() && split.words.size() > 2) {
      column.unit = *unit;
      split.words.erase(unit);
    }
  }
  if (split.words.empty()) {
    // pandas and R write row numbers under no name.
    column.role = ColumnRole::kIgnored;
    return column;
  }
  const std::string joined = Joined(split.words);
  const WholeName* const whole = FindWholeName(joined);
  const NameList meaning = WithoutFillers(split.words);
  const CsvColumn blank = column;
  // Each rule starts from the bare name: one that does not match may have set some of what the next would not.
  const auto attempt = [&](auto&& rule) {
    CsvColumn trial = blank;
    if (!rule(&trial)) return false;
    column = std::move(trial);
    return true;
  };
  const bool plain = split.function.empty() || split.function == "abs";
  // "theta_o=0" is no "theta_o - theta_0".
  const bool equals = name.find('=') != std::string_view::npos;
  const bool may_be_fixed = plain && fixed == Fixed::kTried;
  const auto take_whole = [&](CsvColumn* c) {
    c->role = whole->role;
    c->coordinate = whole->coordinate;
    c->magnitude = split.magnitude;
    // 45as15 is 15 degrees from the mirror direction towards the light (ASTM E2194, DIN 6175-2).
    c->reversed = c->aspecular = joined.starts_with("aspecular");
    return true;
  };
  const auto as_channel = [](bool known, CsvColumn* c) {
    if (known) c->role = ColumnRole::kChannel;
    return known;
  };
  const NameList& words = split.words;
  // By the first rule that matches.
  const bool known =
      (may_be_fixed && equals &&
       attempt([&](CsvColumn* c) { return ClassifyFixed(words, c) && c->role == ColumnRole::kFixed; })) ||
      (plain && whole != nullptr && attempt(take_whole)) ||
      (plain && attempt([&](CsvColumn* c) { return ClassifyCosineOfWholeName(joined, c); })) ||
      attempt([&](CsvColumn* c) { return ClassifyValue(split, c); }) ||
      attempt([&](CsvColumn* c) { return ClassifySpread(split, c); }) ||
      (plain && (attempt([&](CsvColumn* c) { return ClassifyPolarisation(words, c); }) ||
                 attempt([&](CsvColumn* c) { return as_channel(ClassifyChannel(words, c), c); }) ||
                 attempt([&](CsvColumn* c) { return ClassifyWavelengthColumn(meaning, c); }) ||
                 attempt([&](CsvColumn* c) { return ClassifyAngle(meaning, split.magnitude, c); }) ||
                 attempt([&](CsvColumn* c) { return ClassifyComponent(words, c); }) ||
                 attempt([&](CsvColumn* c) { return as_channel(ClassifyValueOfChannel(words, c), c); }))) ||
      (may_be_fixed && attempt([&](CsvColumn* c) { return ClassifyFixed(words, c); }));
  if (!known && (IsIgnoredName(joined) || IsMuellerRatio(words))) column.role = ColumnRole::kIgnored;
  ParseColumnUnit(&column);
  return column;
}

}  // namespace

CsvColumn ClassifyColumn(std::string_view name) { return ClassifyName(name, Fixed::kTried); }

void SetUnit(std::string_view unit, CsvColumn* column) {
  // The unit in the name of a channel is its wavelength's.
  const bool of_wavelength = column->role == ColumnRole::kChannel && column->wavelength_nm > 0;
  if (!column->unit.empty() && !of_wavelength) return;
  std::string_view text = Trim(unit);
  if (text.size() > 1 && (text.front() == '(' || text.front() == '[') && (text.back() == ')' || text.back() == ']'))
    text = text.substr(1, text.size() - 2);
  column->unit = PlainUnit(text);
  if (column->foreign && column->unit == "grad") column->unit = "deg";
  // "Scatter" in degrees is an angle.
  if ((column->role == ColumnRole::kUnknown || column->role == ColumnRole::kOtherValue) &&
      ParseAngleUnit(column->unit)) {
    CsvColumn angle = ClassifyColumn(column->name + " (" + column->unit + ")");
    if (angle.role == ColumnRole::kCoordinate) {
      angle.name = column->name;
      *column = std::move(angle);
      return;
    }
  }
  ParseColumnUnit(column);
}

bool LooksLikeAngle(const CsvColumn& column) {
  if (column.role != ColumnRole::kUnknown) return false;
  const NameWords split = SplitName(column.name);
  if (ParseAngleUnit(column.unit)) return true;
  // "dphi [turn]": the words without the unit that is not known are an angle's.
  return std::any_of(split.words.begin(), split.words.end(), [](const std::string& word) {
    return IsAngleWord(word) || ParseAngleUnit(word).has_value() || IsAngleShorthand(word);
  });
}

std::string QuotedName(const CsvColumn& column) { return "'" + Excerpt(column.name) + "'"; }

std::string AllowedColumns() {
  return "theta_i, phi_i, theta_o, phi_o, dphi, azimuth with incidence and receive, theta_o - theta_i, bistatic angle, "
         "deviation angle, beta - beta0, "
         "theta_h phi_h theta_d "
         "phi_d, wi_x ... wo_z, sample_rotation, wavelength, one of f fr f_r brdf bsdf value, or R G B, or X Y Z, or "
         "wavelengths as 550nm; "
         "sigma, weight; other names by --columns theta_i=NAME,...";
}

}  // namespace lobefit
