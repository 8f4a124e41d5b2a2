#include "lobefit/io/csv/head/keys.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/conventions.h"
#include "lobefit/io/csv/head/mapping.h"
#include "lobefit/io/csv/head/no_value.h"
#include "lobefit/io/csv/head/phrases.h"
#include "lobefit/io/csv/head/row_conditions.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"
#include "lobefit/math/vec.h"
#include "lobefit/measurement/prepare/exclusion.h"
#include "lobefit/measurement/prepare/polarisation.h"

namespace lobefit {
namespace {

// "Angle Unit", "angle_unit" and "AngleUnit" are "angle-unit".
std::string KeyName(std::string_view text) {
  std::string name;
  const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto is_upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  text = Trim(text);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_upper(c) && i > 0 && is_lower(text[i - 1])) name += '-';
    if (is_lower(c) || is_upper(c) || (c >= '0' && c <= '9')) {
      name += is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  while (!name.empty() && name.back() == '-') name.pop_back();
  return name;
}

template <class Value>
void Set(const InputFile& file, std::size_t line, std::string_view key, std::string_view word,
         const std::string& allowed, const std::optional<Value>& value, std::optional<Value>* target) {
  if (!value) FailAtLine(file, line, std::string(key) + " is '" + Excerpt(word) + "'; allowed are " + allowed);
  *target = value;
}

// Takes the text of an option that the file states for itself. Its parser speaks to whoever typed an option; here it is
// the file that is wrong, in this line.
template <class Parse>
void SetOption(const InputFile& file, std::size_t line, std::string_view word, const Parse& parse,
               std::string* target) {
  std::string text(word);
  try {
    parse(text);
  } catch (const UsageError& error) {
    FailAtLine(file, line, error.what());
  }
  *target = std::move(text);
}

// The kind of value that a word of the option's table or a column's name stands for.
std::optional<ValueKind> KindOf(std::string_view word) {
  if (const std::optional<ValueKind> kind = ParseValueKind(word)) return kind;
  return ClassifyColumn(word).value_kind;
}

// Of a source or detector as seen from the sample; as recipes allow.
constexpr double kLargestHalfAngleDeg = 30;

// As recipes allow.
constexpr double kMostAlignmentDegrees = 5;

// "1.5 deg" without its unit.
std::string_view NumberOfDegrees(std::string_view word) {
  for (const std::string_view unit : {"degrees", "deg"}) {
    if (word.ends_with(unit)) return Trim(word.substr(0, word.size() - unit.size()));
  }
  return word;
}

// "1.5 deg", "1.5 +- 0.2 deg", "1.5 x 4 deg" of a rectangle.
struct HalfAngle {
  double degrees = 0;
  std::optional<double> uncertainty, across;
};
std::optional<HalfAngle> ParseHalfAngle(std::string_view word) {
  word = NumberOfDegrees(word);
  for (const std::string_view sign : {"+-", "+/-", "\u00b1"}) {
    const std::size_t at = word.find(sign);
    if (at == std::string_view::npos) continue;
    const std::optional<double> value = ParseDouble(NumberOfDegrees(Trim(word.substr(0, at)))),
                                uncertainty = ParseDouble(Trim(word.substr(at + sign.size())));
    if (!value || !uncertainty) return std::nullopt;
    return HalfAngle{*value, uncertainty, {}};
  }
  if (const std::size_t at = word.find('x'); at != std::string_view::npos) {
    const std::optional<double> value = ParseDouble(NumberOfDegrees(Trim(word.substr(0, at)))),
                                across = ParseDouble(Trim(word.substr(at + 1)));
    if (!value || !across) return std::nullopt;
    return HalfAngle{*value, {}, across};
  }
  const std::optional<double> value = ParseDouble(word);
  if (!value) return std::nullopt;
  return HalfAngle{*value, {}, {}};
}

bool Is(const std::string& name, std::initializer_list<std::string_view> spellings) {
  return std::find(spellings.begin(), spellings.end(), name) != spellings.end();
}

// Those that change what numbers mean.
const std::vector<std::string>& KnownUnitKeys() {
  static const std::vector<std::string> keys = {"angle-unit",     "value-kind",      "value-scale",
                                                "incident-sense", "wavelength-unit", "sample-rotation-deg",
                                                "sample-rotation"};
  return keys;
}

// And those that choose among columns and rows: prose has such words too ("Repeats: 3", "X_Columns").
const std::vector<std::string>& KnownChoiceKeys() {
  static const std::vector<std::string> keys = {"no-value", "exclude", "columns", "value-column", "repeated"};
  return keys;
}

// What concerns the values and is not used, and a key that is none, though it has a word of one: said, so that a unit
// does not go unread in silence.
void RemarkOnUnused(std::size_t line, std::string_view key, const std::string& name, std::string_view word,
                    CsvKeys* keys) {
  if (name.empty() || name.size() > 30 || Trim(word).empty() || key == "comment") return;
  if (key.starts_with("truth, ")) return;  // of synth, whose materials have a scale
  const ColumnRole role = ClassifyColumn(key).role;
  if (role == ColumnRole::kPolarisation && !IsUnpolarised(ToLower(word))) {
    keys->remarks.push_back("line " + std::to_string(line) + ": the polarisation is '" + Excerpt(word, 40) +
                            "': the values are f_r of that light, not of unpolarised light");
    return;
  }
  if (role == ColumnRole::kSigma && (name.find("cert") != std::string::npos || word.ends_with('%'))) {
    keys->remarks.push_back(
        "line " + std::to_string(line) + ": the uncertainty that '" + Excerpt(key, 40) +
        "' states for all values was not used; write it into a column, as 'relative uncertainty (%)'");
    return;
  }
  const auto has = [&](std::string_view part) { return name.find(part) != std::string::npos; };
  const bool resembles = has("unit") || has("sense") || has("convention") || has("cosine") || has("scale") ||
                         has("factor") || ParseAngleUnit(word) || ParseIncidentSense(word) || ParseValueKind(word);
  const std::string start = "line " + std::to_string(line) + ": the key '" + Excerpt(key) + "' is not known";
  if (resembles) {
    keys->remarks.push_back(start + " and was not used; known are " + Join(KnownUnitKeys()) + ", " +
                            Join(KnownChoiceKeys()) + ", theta_i and the other angles, wavelength");
    return;
  }
  const std::string suggestion = name.size() > 5 ? DidYouMean(name, KnownChoiceKeys()) : "";
  if (!suggestion.empty()) keys->remarks.push_back(start + suggestion + " and was not used");
}

// Without the quotes that YAML and TOML put around a text.
std::string_view WithoutQuotes(std::string_view word) {
  const bool quoted = word.size() > 1 && (word.front() == '"' || word.front() == '\'') && word.back() == word.front();
  return quoted ? Trim(word.substr(1, word.size() - 2)) : word;
}

bool TakeColumnUnits(std::string_view text, CsvKeys* keys) {
  const std::vector<ColumnUnit> found = FindColumnUnits(text);
  for (const ColumnUnit& unit : found) {
    if (std::find(keys->column_units.begin(), keys->column_units.end(), unit) == keys->column_units.end())
      keys->column_units.push_back(unit);
  }
  return !found.empty();
}

}  // namespace

void CsvKeys::Fix(const FixedCoordinate& coordinate) {
  for (FixedCoordinate& known : fixed) {
    if (known.coordinate != coordinate.coordinate) continue;
    known = coordinate;
    return;
  }
  fixed.push_back(coordinate);
}

const FixedCoordinate* CsvKeys::Find(Coordinate coordinate) const {
  for (const FixedCoordinate& known : fixed) {
    if (known.coordinate == coordinate) return &known;
  }
  return nullptr;
}

bool ReadKey(const InputFile& file, std::size_t line, std::string_view text, CsvKeys* keys) {
  if (ReadConvention(line, text, keys)) return true;
  const std::size_t at = text.find_first_of(":=");
  if (at == std::string_view::npos)
    return ReadSentence(text, keys) || ReadPhrase(text, keys) || ReadMention(text, keys) || TakeColumnUnits(text, keys);
  if (ReadCoordinates(text, keys)) return true;
  const std::string_view key = WithoutQuotes(Trim(text.substr(0, at))), word = WithoutQuotes(Trim(text.substr(at + 1)));
  const std::string name = KeyName(key);
  if (Is(name, {"angle-unit", "angle-units", "angular-unit", "angular-units", "unit-of-angle", "unit-of-angles",
                "units-of-angle", "units-of-angles"})) {
    Set(file, line, "angle-unit", word, "deg, rad, gon, mrad, arcmin, arcsec", ParseAngleUnit(word), &keys->angle_unit);
  } else if (Is(name, {"units", "unit", "angles", "angle", "winkel", "angulos", "angoli"}) && ParseAngleUnit(word)) {
    keys->angle_unit = ParseAngleUnit(word);
  } else if (Is(name, {"value-kind", "values-kind", "kind-of-value", "kind-of-values"})) {
    Set(file, line, "value-kind", word, AllowedValueKinds(), KindOf(word), &keys->value_kind);
  } else if (Is(name, {"value-scale", "value-unit", "value-units", "values-unit"})) {
    Set(file, line, "value-scale", word, "1/sr, %, dB, log10, ln, a power of ten as in 1e-3/sr, a.u.",
        ParseValueScale(word), &keys->value_scale);
  } else if (Is(name, {"incident", "incident-sense", "incident-direction", "sense-of-incidence", "incidence-sense"}) &&
             !ParseQuantity(word)) {
    Set(file, line, "incident", word, "towards, propagation", ParseIncidentSense(word), &keys->incident_sense);
  } else if (Is(name, {"wavelength-unit", "wavelength-units", "wavelengths-unit", "unit-of-wavelength",
                       "unit-of-wavelengths"})) {
    Set(file, line, "wavelength-unit", word, "nm, um, mm, m, A, cm^-1, eV, THz, GHz", ParseWavelengthUnit(word),
        &keys->wavelength_unit);
  } else if (name == "sample-rotation-deg") {
    const std::optional<double> degrees = ParseDouble(word);
    if (!degrees || !std::isfinite(*degrees)) {
      FailAtLine(file, line, "sample-rotation-deg is '" + Excerpt(word) + "'; a number of degrees is allowed");
    }
    keys->Fix({Coordinate::kSampleRotation, *degrees, AngleUnit::kDegrees});
  } else if (name == "turned") {
    // Half a turn on the stage, as an alignment is told from a tilt by.
    if (word != "true" && word != "false" && word != "180")
      FailAtLine(file, line, "turned is '" + Excerpt(word) + "'; allowed are true, false");
    if (word != "false") keys->Fix({Coordinate::kSampleRotation, 180, AngleUnit::kDegrees});
  } else if (name == "columns") {
    // "Columns: incidence, azimuth, value" is prose.
    if (word.find('=') == std::string_view::npos) return false;
    SetOption(
        file, line, word, [](const std::string& words) { ColumnMapping mapping(words); }, &keys->columns);
  } else if (name == "where") {
    SetOption(file, line, word, ParseRowConditions, &keys->where);
  } else if (name == "no-value") {
    SetOption(
        file, line, word, [](const std::string& words) { NoValues marks(words); }, &keys->no_value);
  } else if (name == "exclude") {
    SetOption(file, line, word, ParseExclusions, &keys->exclude);
  } else if ((name == "source" || name == "detector") && ParseHalfAngle(word)) {
    // Without a number it is prose ("# source: xenon lamp").
    const HalfAngle stated = *ParseHalfAngle(word);
    if (!(stated.degrees >= 0 && stated.degrees <= kLargestHalfAngleDeg)) {
      FailAtLine(file, line,
                 name + " is '" + Excerpt(word) + "'; the half angle of its disc is allowed, 0 to " +
                     FormatDouble(kLargestHalfAngleDeg) + " degrees");
    }
    if (stated.uncertainty &&
        !(*stated.uncertainty > 0 && *stated.uncertainty <= kLargestHalfAngleDeg && stated.degrees > 0)) {
      FailAtLine(file, line,
                 name + " is '" + Excerpt(word) +
                     "'; as in 1.5 +- 0.2 a half angle above 0 and its standard deviation are allowed, both at most " +
                     FormatDouble(kLargestHalfAngleDeg) + " degrees");
    }
    StatedInstrument* instrument = &keys->instrument;
    const bool is_source = name == "source";
    if (stated.across &&
        (is_source || !(*stated.across > 0 && *stated.across <= kLargestHalfAngleDeg && stated.degrees > 0))) {
      FailAtLine(file, line,
                 name + " is '" + Excerpt(word) +
                     "'; as in 1.5 x 4 the half angles of a rectangular detector are allowed, along the meridian and "
                     "across it, above 0 and at most " +
                     FormatDouble(kLargestHalfAngleDeg) + " degrees");
    }
    if (!is_source) {
      instrument->detector_across.reset();
      if (stated.across) instrument->detector_across = DegreesToRadians(*stated.across);
    }
    (is_source ? instrument->source : instrument->detector) = DegreesToRadians(stated.degrees);
    std::optional<double>& prior = is_source ? instrument->source_prior : instrument->detector_prior;
    prior.reset();
    if (stated.uncertainty) prior = DegreesToRadians(*stated.uncertainty);
  } else if (name == "mean" && (word == "flux" || word == "plain")) {
    keys->instrument.plain_mean = word == "plain";
  } else if (name == "drift" && (word == "auto" || ParseDouble(word))) {
    // As of source and detector, other words are prose ("# drift: not seen").
    keys->instrument.drift = ParseDrift(word);
    if (!keys->instrument.drift) {
      FailAtLine(file, line,
                 "drift is '" + Excerpt(word) +
                     "'; allowed are auto and the relative standard deviation of the gains, above 0 and at most 1");
    }
  } else if (name == "alignment" && ParseDouble(NumberOfDegrees(word))) {
    const double degrees = *ParseDouble(NumberOfDegrees(word));
    if (!(degrees > 0 && degrees <= kMostAlignmentDegrees)) {
      FailAtLine(
          file, line,
          "alignment is '" + Excerpt(word) +
              "'; the standard deviation by which the sample may stand crooked is allowed, above 0 and at most " +
              FormatDouble(kMostAlignmentDegrees) + " degrees");
    }
    keys->instrument.alignment = DegreesToRadians(degrees);
  } else if (name == "offset" && (word == "true" || word == "false")) {
    keys->instrument.offset = word == "true";
  } else if (Is(name, {"noise", "noise-model"}) && word.find('=') != std::string_view::npos) {
    keys->instrument.noise = ParseNoiseModel(word);
    if (!keys->instrument.noise) {
      FailAtLine(file, line,
                 std::string(key) + " is '" + Excerpt(word) +
                     "'; as in floor=0.002, relative=0.03, poisson=0.0001 the floor and the reading of one count are "
                     "allowed, in 1/sr, one of them above 0, and the relative part, above 0 and at most 1");
    }
  } else if (name == "value-column") {
    keys->value_column = std::string(word);
  } else if (name == "repeated") {
    if (!ParseRepeatedRows(word))
      FailAtLine(file, line, "repeated is '" + Excerpt(word) + "'; allowed are first, mean");
    keys->repeated = std::string(word);
  } else if (!ReadUnits(name, word, keys) && !ReadCoordinate(key, word, keys) && !ReadParts(text, keys) &&
             !ReadMention(text, keys) && !TakeColumnUnits(text, keys)) {
    // A misspelt key would leave the file read in the wrong unit without a word.
    const std::string suggestion = name.size() > 5 ? DidYouMean(name, KnownUnitKeys()) : "";
    if (!suggestion.empty()) FailAtLine(file, line, "the key '" + Excerpt(key) + "' is not known" + suggestion);
    RemarkOnUnused(line, key, name, word, keys);
    return false;
  }
  return true;
}

bool ReadKey(const InputFile& file, std::size_t line, const std::vector<std::string_view>& fields, CsvKeys* keys) {
  std::vector<std::string_view> filled;
  for (const std::string_view field : fields) {
    if (!Trim(field).empty()) filled.push_back(WithoutQuotes(Trim(field)));
  }
  if (filled.empty() || filled.size() > 3) return false;
  // "Incident,,Reflected" are headings of columns.
  const auto is_empty = [](std::string_view field) { return Trim(field).empty(); };
  const auto first = std::find_if_not(fields.begin(), fields.end(), is_empty);
  if (filled.size() > 1 && is_empty(*(first + 1)) && std::none_of(filled.begin(), filled.end(), [](std::string_view f) {
        return f.find_first_of("0123456789:=") != std::string_view::npos;
      }))
    return false;
  std::string text(filled[0]);
  // "AOI = 30" between blanks has its mark in a field of its own.
  const bool marked = filled[0].find_first_of(":=") != std::string_view::npos ||
                      (filled.size() > 1 && filled[1].find_first_of(":=") == 0);
  if (!marked) {
    if (filled.size() == 1 && ReadConvention(line, filled[0], keys)) return true;
    if (filled.size() == 1)
      return ReadSentence(filled[0], keys) || ReadPhrase(filled[0], keys) || ReadMention(filled[0], keys);
    // "Scan 3, incidence 30 deg"
    for (const std::string_view field : filled) {
      if (ReadPhrase(field, keys)) return true;
    }
    text += ':';
  } else if (filled.size() > 1 && ReadParts(Join({filled.begin(), filled.end()}, ";"), keys)) {
    return true;
  }
  for (std::size_t i = 1; i < filled.size(); ++i) {
    text += ' ';
    text += filled[i];
  }
  return ReadKey(file, line, text, keys);
}

void RequireSameUnits(const InputFile& file, std::size_t line, const CsvKeys& before, const CsvKeys& after) {
  const auto require = [&](bool same, const char* key) {
    if (!same)
      FailAtLine(file, line,
                 std::string(key) +
                     " changes after rows have been read; put the parts into files of their own and name them all");
  };
  require(before.angle_unit == after.angle_unit, "angle-unit");
  require(before.value_kind == after.value_kind, "value-kind");
  require(before.incident_sense == after.incident_sense, "incident");
  require(before.value_scale.has_value() == after.value_scale.has_value(), "value-scale");
  require(before.wavelength_unit.has_value() == after.wavelength_unit.has_value(), "wavelength-unit");
  require(before.columns == after.columns && before.where == after.where && before.no_value == after.no_value &&
              before.exclude == after.exclude && before.value_column == after.value_column &&
              before.repeated == after.repeated,
          "columns, where, no-value, exclude, value-column or repeated");
}

}  // namespace lobefit
