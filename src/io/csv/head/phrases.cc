#include "lobefit/io/csv/head/phrases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/names/name_rules.h"

namespace lobefit {
namespace {

// Takes a unit of a kind that is not known yet, or the same again ("rad, rad, 1/sr" of columns).
bool TakeUnit(std::string_view unit, CsvKeys* keys) {
  if (const std::optional<AngleUnit> angle = ParseAngleUnit(unit);
      angle && keys->angle_unit.value_or(*angle) == *angle) {
    keys->angle_unit = angle;
  } else if (const std::optional<ValueScale> scale = ParseValueScale(unit); scale && !keys->value_scale) {
    keys->value_scale = scale;
  } else if (const std::optional<WavelengthUnit> length = ParseWavelengthUnit(unit); length && !keys->wavelength_unit) {
    keys->wavelength_unit = length;
  } else {
    return false;
  }
  return true;
}

// The unit of what `subject` names; false where it names nothing or the unit is none of its kind.
bool TakeUnitOf(std::string_view subject, std::string_view unit, CsvKeys* keys) {
  const CsvColumn column = ClassifyColumn(subject);
  switch (column.role) {
    case ColumnRole::kCoordinate:
      if (!ParseAngleUnit(unit) || keys->angle_unit) return false;
      keys->angle_unit = ParseAngleUnit(unit);
      return true;
    case ColumnRole::kValue:
    case ColumnRole::kOtherValue:
      if (!ParseValueScale(unit) || keys->value_scale) return false;
      keys->value_scale = ParseValueScale(unit);
      return true;
    case ColumnRole::kWavelength:
      if (!ParseWavelengthUnit(unit) || keys->wavelength_unit) return false;
      keys->wavelength_unit = ParseWavelengthUnit(unit);
      return true;
    default:
      return false;
  }
}

std::vector<std::string_view> PlainWords(const std::string& lower) {
  std::vector<std::string_view> words = SplitBlanks(lower);
  for (std::string_view& word : words) {
    while (!word.empty() && std::string_view(".,;()[]").find(word.back()) != std::string_view::npos)
      word.remove_suffix(1);
    while (!word.empty() && (word.front() == '(' || word.front() == '[')) word.remove_prefix(1);
  }
  return words;
}

// "unit-angles", "einheit-winkel", "unit-des-angles": of the key, as KeyName spells it.
bool NamesUnitOfAngles(const std::string& name) {
  static constexpr std::array<std::string_view, 9> kUnits = {"unit",   "units",  "einheit", "einheiten", "unite",
                                                             "unites", "unidad", "unita",   "eenheid"};
  static constexpr std::array<std::string_view, 12> kAngles = {"angle",    "angles",  "angular", "winkel",
                                                               "angulo",   "angulos", "angolo",  "angoli",
                                                               "angolare", "hoek",    "hoeken",  "angulaire"};
  bool unit = false, angle = false;
  for (const std::string_view part : Split(name, '-')) {
    unit = unit || HoldsWord(kUnits, part);
    angle = angle || HoldsWord(kAngles, part);
  }
  return unit && angle;
}

}  // namespace

std::optional<Quantity> ParseQuantity(std::string_view text) {
  std::string plain(Trim(text));
  std::replace(plain.begin(), plain.end(), ',', '.');
  for (std::size_t n = plain.size(); n > 0; --n) {
    const char last = plain[n - 1];
    if (!(last >= '0' && last <= '9') && last != '.') continue;
    const std::optional<double> number = ParseDouble(std::string_view(plain).substr(0, n));
    if (!number || !std::isfinite(*number)) continue;
    std::string_view unit = Trim(std::string_view(plain).substr(n));
    if (unit.size() > 1 && (unit.front() == '(' || unit.front() == '[')) unit = unit.substr(1, unit.size() - 2);
    return Quantity{*number, PlainUnit(unit)};
  }
  return std::nullopt;
}

// "# 633 nm", "Laser: 633 nm", "Filter 550 nm": a light by its wavelength. Widths of filters are smaller.
bool ReadLight(std::string_view key, const Quantity& quantity, CsvKeys* keys) {
  static constexpr std::array<std::string_view, 8> kLights = {"",      "laser", "filter", "led",
                                                              "diode", "band",  "line",   "interference filter"};
  const std::optional<WavelengthUnit> unit = quantity.unit.empty() || quantity.unit == "m" || quantity.unit == "a"
                                                 ? std::nullopt
                                                 : ParseWavelengthUnit(quantity.unit);
  if (!unit || unit->reciprocal || !HoldsWord(kLights, ToLower(key))) return false;
  const double nm = unit->ToNm(quantity.number);
  if (!(nm >= 200 && nm <= 20000)) return false;
  keys->wavelength_nm = std::round(nm * 1e6) / 1e6;
  return true;
}

bool ReadCoordinate(std::string_view key, std::string_view word, CsvKeys* keys) {
  CsvColumn column = ClassifyColumn(key);
  const std::optional<Quantity> quantity = ParseQuantity(word);
  if (!quantity) return false;
  if (column.role == ColumnRole::kUnknown && ReadLight(key, *quantity, keys)) return true;
  // "Illumination: 45 deg"
  if (column.role == ColumnRole::kUnknown && !quantity->unit.empty() && ParseAngleUnit(quantity->unit)) {
    CsvColumn angle = ClassifyColumn(std::string(key) + " (" + quantity->unit + ")");
    if (angle.role == ColumnRole::kCoordinate && angle.coordinate == Coordinate::kThetaI) column = std::move(angle);
  }
  if (column.role == ColumnRole::kWavelength) {
    const std::string& unit = quantity->unit.empty() ? column.unit : quantity->unit;
    const std::optional<WavelengthUnit> known =
        unit.empty() ? std::optional(WavelengthUnit{quantity->number < 100 ? 1e3 : 1.0}) : ParseWavelengthUnit(unit);
    if (!known || !(quantity->number > 0)) return false;
    keys->wavelength_nm = std::round(known->ToNm(quantity->number) * 1e6) / 1e6;
    return true;
  }
  if (column.role != ColumnRole::kCoordinate || column.coordinate == Coordinate::kTheta) return false;
  const std::optional<AngleUnit> unit = quantity->unit.empty() ? column.angle_unit : ParseAngleUnit(quantity->unit);
  if (!quantity->unit.empty() && !unit) return false;
  if (column.coordinate == Coordinate::kPhi) {
    keys->lone_azimuth = std::string(key) + ": " + std::string(word);
    return true;
  }
  keys->Fix({column.coordinate, quantity->number, unit, column.form});
  return true;
}

bool ReadCoordinates(std::string_view text, CsvKeys* keys) {
  CsvKeys all = *keys;
  Coordinate last = Coordinate::kPhi;
  const std::vector<std::string_view> parts = Split(text, text.find(';') == std::string_view::npos ? ',' : ';');
  if (parts.size() < 2) return false;
  for (const std::string_view part : parts) {
    const std::size_t at = part.find_first_of(":=");
    if (at == std::string_view::npos) return false;
    std::string key(Trim(part.substr(0, at)));
    const CsvColumn column = ClassifyColumn(key);
    // "incident zenith: 30 deg, azimuth: 90 deg"
    if (column.role == ColumnRole::kCoordinate && column.coordinate == Coordinate::kPhi) {
      key = last == Coordinate::kThetaI ? "phi_i" : last == Coordinate::kThetaO ? "phi_o" : "";
    }
    if (!ReadCoordinate(key, Trim(part.substr(at + 1)), &all)) return false;
    last = column.coordinate;
  }
  *keys = std::move(all);
  return true;
}

bool ReadPhrase(std::string_view text, CsvKeys* keys) {
  constexpr std::size_t kMostWords = 6;  // more are a description
  const std::vector<std::string_view> words = SplitBlanks(text);
  if (!words.empty() && words.size() <= 2) {
    const std::optional<Quantity> whole = ParseQuantity(text);
    if (whole && ReadLight("", *whole, keys)) return true;
  }
  if (words.size() < 2 || words.size() > kMostWords) return false;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (!ParseQuantity(words[i]) || !(words[i].front() >= '-' && words[i].front() <= '9')) continue;
    const auto at = static_cast<std::size_t>(words[i].data() - text.data());
    std::string_view quantity = Trim(text.substr(at));
    if (quantity.ends_with('.')) quantity.remove_suffix(1);
    return ReadCoordinate(Trim(text.substr(0, at)), quantity, keys);
  }
  return false;
}

bool ReadSentence(std::string_view text, CsvKeys* keys) {
  const std::string lower = ToLower(text);
  const std::vector<std::string_view> words = PlainWords(lower);
  static constexpr std::array<std::string_view, 6> kAngleWords = {"angles",  "angle",  "winkel",
                                                                  "angulos", "angoli", "azimuths"};
  constexpr std::size_t kMostWords = 12;  // more are a description
  std::optional<AngleUnit> unit;
  bool angles = false;
  if (words.size() > kMostWords) return false;
  if (words.size() == 1 && ParseAngleUnit(words[0]) && !keys->angle_unit) {
    keys->angle_unit = ParseAngleUnit(words[0]);
    return true;
  }
  if (words.size() > 2 && words[words.size() - 2] == "in") {
    static constexpr std::array<std::string_view, 8> kBeside = {"all",      "are", "is",  "given",
                                                                "measured", "the", "and", "stated"};
    std::string subject;
    for (std::size_t i = 0; i + 2 < words.size(); ++i) {
      if (!HoldsWord(kBeside, words[i])) subject += " " + std::string(words[i]);
    }
    if (TakeUnitOf(subject, words.back(), keys)) return true;
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    angles = angles || std::find(kAngleWords.begin(), kAngleWords.end(), words[i]) != kAngleWords.end();
    const std::optional<AngleUnit> own = i > 0 ? ParseAngleUnit(words[i]) : std::nullopt;
    if (!own) continue;
    if (unit) return false;
    // "30 deg" is an angle.
    if (words[i - 1] != "in" && words[i - 1] != "are" && words[i - 1] != "angles") return false;
    unit = own;
  }
  if (!angles || !unit || keys->angle_unit) return false;
  keys->angle_unit = unit;
  return true;
}

bool ReadParts(std::string_view text, CsvKeys* keys) {
  CsvKeys all = *keys;
  bool any = false;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find_first_of(",;|", begin), text.size());
    const std::string_view part = text.substr(begin, end - begin);
    const std::size_t at = part.find_first_of(":=");
    if (ParseQuantity(part)) return false;  // "incident direction: 30, 90" is a list
    any = (at != std::string_view::npos && ReadCoordinate(Trim(part.substr(0, at)), Trim(part.substr(at + 1)), &all)) ||
          any;
    begin = end + 1;
  }
  if (any) *keys = std::move(all);
  return any;
}

bool ReadMention(std::string_view text, CsvKeys* keys) {
  constexpr std::size_t kMostWords = 12;  // more are a description
  constexpr std::size_t kMostOfName = 3;
  static constexpr std::array<std::string_view, 10> kNames = {
      "incidence", "incidence angle", "incident angle", "angle of incidence", "aoi",
      "theta_i",   "thetai",          "theta_in",       "einfallswinkel",     "einfall"};
  static constexpr std::array<std::string_view, 6> kLists = {"and", "to", "or", "-", "from", "by"};
  static constexpr std::array<std::string_view, 6> kBetween = {"at", "of", "is", "=", "was", ":"};
  // "the plane of incidence" and the like are no angle.
  static constexpr std::array<std::string_view, 4> kOthers = {"plane", "port", "step", "steps"};
  const std::string lower = ToLower(text);
  const std::vector<std::string_view> raw = SplitBlanks(lower), words = PlainWords(lower);
  if (words.size() > kMostWords || (keys->Find(Coordinate::kThetaI) != nullptr && keys->mention_of_incidence.empty()))
    return false;
  std::optional<Quantity> angle;
  std::size_t first = 0, behind = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].empty() || !(words[i].front() >= '-' && words[i].front() <= '9')) continue;
    const std::optional<Quantity> quantity = ParseQuantity(words[i]);
    if (!quantity) continue;
    const bool apart = quantity->unit.empty() && i + 1 < words.size() && ParseAngleUnit(PlainUnit(words[i + 1]));
    if (!apart && !ParseAngleUnit(quantity->unit)) continue;
    // Of several angles none is that of all rows.
    if (angle || (i > 0 && (HoldsWord(kLists, words[i - 1]) || ParseQuantity(words[i - 1])))) return false;
    angle = Quantity{quantity->number, apart ? PlainUnit(words[i + 1]) : quantity->unit};
    first = i;
    behind = i + (apart ? 2 : 1);
  }
  if (!angle) return false;
  while (first > 0 && HoldsWord(kBetween, words[first - 1])) --first;
  // A comma or a bracket parts what stands before it from what follows.
  const auto is_one = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i + 1 < end; ++i) {
      if (raw[i].ends_with(',') || raw[i].ends_with(';') || raw[i].ends_with(')') || raw[i + 1].starts_with('('))
        return false;
    }
    return true;
  };
  const auto names_incidence = [&](std::size_t begin, std::size_t end) {
    std::string name;
    for (std::size_t i = begin; i < end; ++i) name += (name.empty() ? "" : " ") + std::string(words[i]);
    return HoldsWord(kNames, name) && !(end < words.size() && HoldsWord(kOthers, words[end]));
  };
  bool of_incidence = false;
  for (std::size_t length = 1; length <= kMostOfName && !of_incidence; ++length) {
    of_incidence = (behind + length <= words.size() && names_incidence(behind, behind + length) &&
                    is_one(behind - 1, behind + length)) ||
                   (length <= first && names_incidence(first - length, first) && is_one(first - length, behind));
  }
  if (!of_incidence) return false;
  keys->Fix({Coordinate::kThetaI, angle->number, ParseAngleUnit(angle->unit)});
  keys->mention_of_incidence = text;
  return true;
}

bool ReadUnits(const std::string& name, std::string_view word, CsvKeys* keys) {
  if (NamesUnitOfAngles(name) && ParseAngleUnit(word)) {
    keys->angle_unit = ParseAngleUnit(word);
    return true;
  }
  CsvKeys all = *keys;
  if (name == "units" || name == "unit") {
    for (const std::string_view unit : Split(word, word.find(';') == std::string_view::npos ? ',' : ';')) {
      if (!TakeUnit(Trim(unit), &all)) return false;
    }
    *keys = std::move(all);
    return true;
  }
  std::string subject = name;
  for (const std::string_view end : {"-units", "-unit"}) {
    if (subject.ends_with(end)) subject.resize(subject.size() - end.size());
  }
  for (const std::string_view begin : {"units-of-", "unit-of-"}) {
    if (subject.starts_with(begin)) subject.erase(0, begin.size());
  }
  return subject != name && TakeUnitOf(subject, word, keys);
}

}  // namespace lobefit
