#include "lobefit/io/csv/head/value_mention.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/names/columns.h"
#include "lobefit/io/csv/names/name_rules.h"
#include "lobefit/io/csv/names/words.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostLetters = 120;  // more are a description
constexpr std::size_t kMostWords = 10;

// One of them stands in every line that names a kind of value; other lines are not taken apart.
bool MayNameKind(std::string_view lower) {
  static constexpr std::array<std::string_view, 20> kParts = {
      "brf",   "brdf",    "bsdf", "bdrf",  "hdrf",   "ars",    "dsf", "factor", "facteur", "faktor",
      "fator", "fattore", "coef", "koeff", "angle-", "angle ", "i/f", "i_f",    "radf",    "reff"};
  return HoldsAnyPart(lower, kParts) || lower.find("reflect") != std::string_view::npos ||
         std::any_of(lower.begin(), lower.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; });
}

// What a line is about that names a kind of value without being about those of the file.
bool SpeaksOfAnother(std::string_view lower) {
  static constexpr std::array<std::string_view, 15> kParts = {"usda",    "calibrat", "nist",   "interpol", "divided",
                                                              "convert", "model",    "fitted", "not ",     "program",
                                                              "file",    "standard", "target", "/ pi",     "/pi"};
  return HoldsAnyPart(lower, kParts);
}

// The part of "Quantity: BRF" behind its mark; all of a line without one, nothing of a key that is about another thing.
std::string_view SubjectOf(std::string_view line) {
  const std::size_t at = line.find_first_of(":=");
  if (at == std::string_view::npos) return line;
  static constexpr std::array<std::string_view, 22> kKeys = {"quantity",     "measured quantity",
                                                             "measurand",    "type",
                                                             "data type",    "datatype",
                                                             "type of data", "data",
                                                             "values",       "value",
                                                             "measurement",  "y",
                                                             "y-axis",       "y axis",
                                                             "y label",      "ylabel",
                                                             "variable",     "signal",
                                                             "title",        "parameter",
                                                             "ordinate",     "messgr\u00f6\u00dfe"};
  const std::string key = ToLower(Trim(line.substr(0, at)));
  return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end() ? Trim(line.substr(at + 1)) : std::string_view();
}

// The value that `name` names, where no shorter or other word would.
bool NamesKind(const std::string& name, CsvColumn* column) {
  CsvColumn found = ClassifyColumn(name);
  if (found.role != ColumnRole::kValue || !found.value_kind || *found.value_kind == ValueKind::kIntensity ||
      *found.value_kind == ValueKind::kReading || !found.problem.empty())
    return false;
  *column = std::move(found);
  return true;
}

struct Found {
  std::vector<ValueKind> kinds;
  std::optional<ValueScale> scale;
};

Found KindsOf(std::string_view subject) {
  Found found;
  CsvColumn column;
  if (NamesKind(std::string(subject), &column)) return {{*column.value_kind}, column.value_scale};
  const NameWords split = SplitName(subject);
  if (split.words.size() > kMostWords) return found;
  constexpr std::size_t kLongest = 5;
  for (std::size_t i = 0; i < split.words.size();) {
    std::size_t length = std::min(kLongest, split.words.size() - i);
    for (; length > 0; --length) {
      const NameList words(split.words.begin() + static_cast<std::ptrdiff_t>(i),
                           split.words.begin() + static_cast<std::ptrdiff_t>(i + length));
      // "f", "r" and "i" are letters of anything, and a filler belongs to no name.
      if (words[0].size() < 3 || IsFiller(words[0]) || IsFiller(words.back())) continue;
      if (NamesKind(Join(words, " "), &column)) break;
    }
    if (length > 0) found.kinds.push_back(*column.value_kind);
    i += std::max<std::size_t>(length, 1);
  }
  if (found.kinds.empty()) return found;
  if (!split.unit.empty()) found.scale = ParseValueScale(split.unit);
  // "BRDF in 10^-3 1/sr", whose unit is two words.
  const std::size_t in = subject.rfind(" in ");
  if (in != std::string_view::npos) {
    if (const std::optional<ValueScale> scale = ParseValueScale(subject.substr(in + 4))) found.scale = scale;
  }
  return found;
}

// Numbers that are related to something else than 1/sr.
bool IsArbitrary(std::string_view lower) {
  static constexpr std::array<std::string_view, 7> kUnits = {"arbitrary unit", "arb. unit",  "arb.unit",    "arb units",
                                                             "a.u.",           "uncalibrat", "unkalibriert"};
  static constexpr std::array<std::string_view, 4> kRelated = {"normali", "normiert", "scaled to", "relative to"};
  static constexpr std::array<std::string_view, 7> kUnity = {"peak",  "maximum", "max.",    "unity",
                                                             "to 1 ", "to 1.0",  "specular"};
  const bool radiance = lower.starts_with("radiance") || lower.find(" radiance") != std::string_view::npos;
  if (HoldsAnyPart(lower, kUnits) || (radiance && lower.find("w/m") != std::string_view::npos)) return true;
  return HoldsAnyPart(lower, kRelated) && (HoldsAnyPart(lower, kUnity) || lower.ends_with("to 1")) &&
         !HoldsAnyPart(lower, std::array<std::string_view, 4>{"angle", "azimuth", "direction", "winkel"});
}

bool IsRelatedToWhite(std::string_view lower) {
  static constexpr std::array<std::string_view, 4> kRelated = {"relative to", "normali", "ratio", "relativ zu"};
  static constexpr std::array<std::string_view, 6> kWhite = {"spectralon", "white",         "ptfe",
                                                             "fluorilon",  "weissstandard", "wei\u00dfstandard"};
  return HoldsAnyPart(lower, kRelated) && HoldsAnyPart(lower, kWhite);
}

// "values are multiplied by 1000", "data in percent", "Werte in dB", "scaling: 0.01": whether the numbers or the values
// are the larger ones no such line says for sure.
bool SpeaksOfMultiple(std::string_view lower) {
  static constexpr std::array<std::string_view, 11> kTimes = {
      "multipl", "times 1", " x 1", " x1", "\u00d7", "* 1", "*1", "scaled by", "scale factor", "scaling", "skalier"};
  static constexpr std::array<std::string_view, 7> kUnits = {"percent", "prozent", "pourcent", "in %",
                                                             "in db",   "decibel", "dezibel"};
  static constexpr std::array<std::string_view, 10> kOfValues = {"value", "data",  "brdf",   "bsdf",    "readings",
                                                                 "werte", "daten", "valeur", "valores", "f_r"};
  const bool scaling = lower.starts_with("scal");
  const bool digits = lower.find_first_of("0123456789") != std::string_view::npos;
  return (HoldsAnyPart(lower, kOfValues) || scaling) &&
         ((digits && HoldsAnyPart(lower, kTimes)) || HoldsAnyPart(lower, kUnits));
}

// Says nothing of both: "BRDF and BTDF".
bool IsTransmission(std::string_view lower) {
  static constexpr std::array<std::string_view, 3> kPassed = {"btdf", "transmiss", "transmitt"};
  static constexpr std::array<std::string_view, 4> kOther = {"brdf", "bsdf", "reflect", "reflex"};
  return HoldsAnyPart(lower, kPassed) && !HoldsAnyPart(lower, kOther);
}

bool IsPolarised(std::string_view lower) {
  static constexpr std::array<std::string_view, 8> kStates = {"s-polar", "p-polar", "s polar",  "p polar",
                                                              "s-pol ",  "p-pol ",  "te-polar", "tm-polar"};
  return HoldsAnyPart(lower, kStates) && lower.find("unpolar") == std::string_view::npos &&
         lower.find(" and ") == std::string_view::npos;
}

bool IsReflectanceAlone(std::string_view lower) {
  static constexpr std::array<std::string_view, 4> kWords = {"reflectance", "reflectivity", "reflexionsgrad",
                                                             "r\u00e9flectance"};
  return HoldsAnyPart(lower, kWords);
}

void TakeQuestion(const std::string& question, ValueMention* mention) {
  if (mention->question.empty()) mention->question = question;
}

}  // namespace

std::optional<ValueKind> KindNamedIn(std::string_view text) {
  static constexpr std::array<std::string_view, 15> kOthers = {"reference", "model", "fit",     "error", "dev",
                                                               "ratio",     "raw",   "dark",    "unc",   "sigma",
                                                               "std",       "diff",  "predict", "simul", "theor"};
  const std::string lower = ToLower(text);
  if (HoldsAnyPart(lower, kOthers) || SpeaksOfAnother(lower) || lower.find("cos") != std::string::npos) return {};
  const Found found = KindsOf(text);
  return found.kinds.size() == 1 ? std::optional(found.kinds[0]) : std::nullopt;
}

ValueMention FindValueMention(const std::vector<std::string>& lines) {
  ValueMention mention;
  bool both = false;
  for (const std::string_view line : lines) {
    if (line.size() > kMostLetters || line.starts_with("truth, ")) continue;
    const std::string lower = ToLower(line);
    if (mention.arbitrary.empty() && IsArbitrary(lower)) mention.arbitrary = line;
    if (mention.multiple.empty() && SpeaksOfMultiple(lower)) mention.multiple = line;
    if (mention.transmission.empty() && IsTransmission(lower)) mention.transmission = line;
    if (mention.polarised.empty() && IsPolarised(lower)) mention.polarised = line;
    const std::string quoted = "'" + Excerpt(line, 60) + "'";
    if (IsRelatedToWhite(lower)) {
      TakeQuestion("a line says " + quoted + ": are the values reflectance factors, pi f_r (--value-kind pi-f)?",
                   &mention);
    }
    if (!MayNameKind(lower) || SpeaksOfAnother(lower)) continue;
    const std::string_view subject = SubjectOf(line);
    if (subject.empty()) continue;
    Found found = KindsOf(subject);
    // The radiance factor of planetary work has the cosine of incidence in it, that of colorimetry has none.
    if (lower.find("i/f") != std::string::npos) found.kinds = {ValueKind::kReflectanceCosI};
    if (found.kinds.empty()) {
      if (IsReflectanceAlone(lower))
        TakeQuestion("a line says " + quoted + ": are the values reflectance factors, pi f_r (--value-kind pi-f)?",
                     &mention);
      continue;
    }
    const bool cosine =
        lower.find("cos") != std::string::npos &&
        std::all_of(found.kinds.begin(), found.kinds.end(), [](ValueKind kind) { return kind == ValueKind::kBrdf; });
    if (cosine) {
      TakeQuestion("a line says " + quoted +
                       ": where the values have a cosine in them, say of which angle (--value-kind f-cos-o or f-cos-i)",
                   &mention);
      continue;
    }
    for (const ValueKind kind : found.kinds) {
      both = both || (mention.kind && *mention.kind != kind);
      if (!mention.kind) {
        mention.kind = kind;
        mention.line = line;
      }
    }
    if (found.scale && !mention.scale && mention.line == line) mention.scale = found.scale;
  }
  if (both) {
    mention.question = "lines name more than one kind of value, as '" + Excerpt(mention.line, 60) +
                       "'; say with --value-kind f|pi-f|f-cos-o|f-cos-i what the values are";
    mention.kind.reset();
    mention.scale.reset();
  }
  if (mention.kind) mention.question.clear();
  return mention;
}

}  // namespace lobefit
