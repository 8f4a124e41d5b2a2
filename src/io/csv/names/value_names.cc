#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/names/name_rules.h"

namespace lobefit {
namespace {

// Words that say nothing about what a column is.
constexpr std::array<std::string_view, 19> kFillers = {
    "of",      "the", "de",       "di",    "del",         "der",         "des",   "la",     "a",   "mean",
    "average", "avg", "measured", "total", "unpolarized", "unpolarised", "value", "values", "from"};
constexpr std::array<std::string_view, 24> kSpread = {
    "sigma",         "std",      "stdev",        "stddev",      "sd",         "sem",           "uncertainty",
    "uncertainties", "unc",      "unsicherheit", "incertitude", "incertezza", "incertidumbre", "error",
    "err",           "fehler",   "erreur",       "deviation",   "u",          "stderr",        "sdev",
    "rsd",           "\xc2\xb1", "errbar"};

constexpr std::array<std::string_view, 7> kWhiteStandards = {"spectralon", "ptfe", "halon",    "fluorilon",
                                                             "white",      "srs",  "labsphere"};
constexpr std::array<std::string_view, 12> kRelatedTo = {"relative",   "rel",      "to",        "vs",
                                                         "versus",     "standard", "reference", "normalised",
                                                         "normalized", "plaque",   "tile",      "panel"};

struct ValueName {
  std::string_view name;
  std::optional<ValueKind> kind;
};
constexpr auto kValues = std::to_array<ValueName>({
    {"value", {}},
    {"values", {}},
    {"val", {}},
    {"wert", {}},
    {"f", ValueKind::kBrdf},
    {"fr", ValueKind::kBrdf},
    {"f_r", ValueKind::kBrdf},
    {"fs", ValueKind::kBrdf},
    {"f_s", ValueKind::kBrdf},
    {"brdf", ValueKind::kBrdf},
    {"bsdf", ValueKind::kBrdf},
    {"bdrf", ValueKind::kBrdf},
    {"brdfs", ValueKind::kBrdf},
    {"f_r11", ValueKind::kBrdf},
    {"f_r_11", ValueKind::kBrdf},
    {"fr_l_over_e", ValueKind::kBrdf},
    {"luminance_coefficient", ValueKind::kBrdf},
    {"luminance_coefficient_q", ValueKind::kBrdf},
    {"fdrb", ValueKind::kBrdf},
    {"frdb", ValueKind::kBrdf},
    {"bidirectional_reflectance_distribution_function", ValueKind::kBrdf},
    {"f_cos_o", ValueKind::kBrdfCosO},
    {"brdf_cos_o", ValueKind::kBrdfCosO},
    {"brdf_cos_theta_o", ValueKind::kBrdfCosO},
    {"brdf_cos_theta_s", ValueKind::kBrdfCosO},
    {"brdf_cos_theta_r", ValueKind::kBrdfCosO},
    {"bsdf_cos_theta_s", ValueKind::kBrdfCosO},
    {"f_cos_theta_o", ValueKind::kBrdfCosO},
    {"f_cos_theta_r", ValueKind::kBrdfCosO},
    {"f_r_cos_theta_r", ValueKind::kBrdfCosO},
    {"f_r_cos_theta_o", ValueKind::kBrdfCosO},
    {"ccbrdf", ValueKind::kBrdfCosO},
    {"ccbsdf", ValueKind::kBrdfCosO},
    {"cosine_corrected_brdf", ValueKind::kBrdfCosO},
    {"cosine_corrected_bsdf", ValueKind::kBrdfCosO},
    {"brdf_cosine_corrected", ValueKind::kBrdfCosO},
    {"bsdf_cosine_corrected", ValueKind::kBrdfCosO},
    {"cos_corrected_brdf", ValueKind::kBrdfCosO},
    {"dsf", ValueKind::kBrdfCosO},
    {"ars", ValueKind::kBrdfCosO},
    {"angle_resolved_scatter", ValueKind::kBrdfCosO},
    {"angle_resolved_scattering", ValueKind::kBrdfCosO},
    {"f_cos_i", ValueKind::kBrdfCosI},
    {"brdf_cos_i", ValueKind::kBrdfCosI},
    {"brdf_cos_theta_i", ValueKind::kBrdfCosI},
    {"f_cos_theta_i", ValueKind::kBrdfCosI},
    {"f_r_cos_theta_i", ValueKind::kBrdfCosI},
    {"pi_f", ValueKind::kReflectanceFactor},
    {"pi_f_r", ValueKind::kReflectanceFactor},
    {"pi_fr", ValueKind::kReflectanceFactor},
    {"pi_brdf", ValueKind::kReflectanceFactor},
    {"f_pi", ValueKind::kReflectanceFactor},
    {"fr_pi", ValueKind::kReflectanceFactor},
    {"f_r_pi", ValueKind::kReflectanceFactor},
    {"brdf_pi", ValueKind::kReflectanceFactor},
    {"brf", ValueKind::kReflectanceFactor},
    {"hdrf", ValueKind::kReflectanceFactor},
    {"reflectance_factor", ValueKind::kReflectanceFactor},
    {"refl_factor", ValueKind::kReflectanceFactor},
    {"bidirectional_reflectance_factor", ValueKind::kReflectanceFactor},
    {"radiance_factor", ValueKind::kReflectanceFactor},
    {"radiance_coefficient", ValueKind::kReflectanceFactor},
    {"reff", ValueKind::kReflectanceFactor},  // of planetary work, pi f_r
    {"strahldichtefaktor", ValueKind::kReflectanceFactor},
    {"strahldichtekoeffizient", ValueKind::kReflectanceFactor},
    {"bidirektionaler_reflexionsfaktor", ValueKind::kReflectanceFactor},
    {"facteur_reflectance", ValueKind::kReflectanceFactor},
    {"facteur_reflectance_bidirectionnelle", ValueKind::kReflectanceFactor},
    {"facteur_luminance", ValueKind::kReflectanceFactor},
    {"facteur_radiance", ValueKind::kReflectanceFactor},
    {"factor_reflectancia", ValueKind::kReflectanceFactor},
    {"factor_reflectancia_bidireccional", ValueKind::kReflectanceFactor},
    {"factor_radiancia", ValueKind::kReflectanceFactor},
    {"fattore_riflettanza", ValueKind::kReflectanceFactor},
    {"fattore_radianza", ValueKind::kReflectanceFactor},
    {"fator_refletancia", ValueKind::kReflectanceFactor},
    {"luminance_factor", ValueKind::kReflectanceFactor},  // of colorimetry
    {"radiance_factor_beta", ValueKind::kReflectanceFactor},
    {"beta_radiance_factor", ValueKind::kReflectanceFactor},
    {"intensity", ValueKind::kIntensity},
    {"rt", ValueKind::kReading},
});

constexpr ByFirstByte<kValues.size()> kValuesByByte(kValues, [](const ValueName& value) { return value.name; });

const ValueName* FindValue(std::string_view joined) {
  const std::size_t found =
      kValuesByByte.Find(joined, [&](std::size_t i) { return SameWord(kValues[i].name, joined); });
  return found < kValues.size() ? &kValues[found] : nullptr;
}

void SetWavelength(double nm, CsvColumn* column) {
  nm = std::round(nm * 1e6) / 1e6;
  column->wavelength_nm = nm;
  column->channel = FormatDouble(nm) + "nm";
}

// "550nm", "550" with the unit of the name, "0.55um", "550".
std::optional<double> WavelengthOf(std::string_view word, const CsvColumn& column) {
  std::size_t digits = word.size();
  while (digits > 0 && !(word[digits - 1] >= '0' && word[digits - 1] <= '9')) --digits;
  std::optional<WavelengthUnit> unit = ParseWavelengthUnit(word.substr(digits));
  if (digits == word.size()) unit = column.unit.empty() ? std::nullopt : ParseWavelengthUnit(column.unit);
  if (digits < word.size() && !unit) return std::nullopt;
  const std::optional<double> number = ParseDouble(word.substr(0, digits));
  if (!number || !std::isfinite(*number) || *number <= 0) return std::nullopt;
  // A bare number is a wavelength only where it can be one in nanometres.
  if (!unit && (!column.unit.empty() || *number < 100 || *number > 20000)) return std::nullopt;
  const double nm = unit ? unit->ToNm(*number) : *number;
  return nm > 0 && std::isfinite(nm) ? std::optional(nm) : std::nullopt;
}

}  // namespace

std::string Joined(const NameList& words) {
  std::string joined;
  for (const std::string& word : words) joined += (joined.empty() ? "" : "_") + word;
  return joined;
}

NameList WithoutFillers(const NameList& words) {
  NameList kept;
  for (const std::string& word : words) {
    if (!HoldsWord(kFillers, word)) kept.push_back(word);
  }
  return kept.empty() ? words : kept;
}

bool IsFiller(std::string_view word) { return HoldsWord(kFillers, word); }

bool ClassifyWavelengthColumn(const NameList& words, CsvColumn* column) {
  static constexpr std::array<std::string_view, 9> kNames = {"wavelength",   "lambda", "wl",          "wave", "wavelen",
                                                             "wellenlaenge", "wavel",  "wellenlange", "wvl"};
  const std::string name = Joined(words);
  const std::string_view joined = name;
  const bool known = (words.size() <= 2 && !words.empty() && HoldsWord(kNames, words[0]) &&
                      (words.size() == 1 || words[1] == "i" || words[1] == "in" || words[1] == "incident")) ||
                     joined == "longueur_d_onde" || joined == "lunghezza_d_onda" || joined == "longitud_onda" ||
                     joined == "comprimento_onda" || joined == "wave_length" ||
                     (words.size() == 2 && IsLightWord(words[0]) && HoldsWord(kNames, words[1]));
  const bool number = joined == "wavenumber" || joined == "wellenzahl";
  // What is said in THz or eV; without a unit it may be the frequency of a chopper.
  const bool inverse =
      (joined == "frequency" || joined == "frequenz" || joined == "photon_energy") && ParseWavelengthUnit(column->unit);
  if (!known && !number && !inverse) return false;
  column->role = ColumnRole::kWavelength;
  if (number && column->unit.empty()) column->unit = "cm^-1";
  return true;
}

// A channel, by itself or beside the name of a value: "R", "brdf_r", "f 550nm", "lambda=550".
bool ClassifyChannel(NameList words, CsvColumn* column) {
  if (words.size() > 1 && (words[0] == "lambda" || words[0] == "wavelength" || words[0] == "wl"))
    words.erase(words.begin());
  if (words.size() != 1) return false;
  const std::string_view word = words[0];
  static constexpr std::array<std::pair<std::string_view, char>, 9> kLetters = {{{"r", 'R'},
                                                                                 {"g", 'G'},
                                                                                 {"b", 'B'},
                                                                                 {"x", 'X'},
                                                                                 {"y", 'Y'},
                                                                                 {"z", 'Z'},
                                                                                 {"red", 'R'},
                                                                                 {"green", 'G'},
                                                                                 {"blue", 'B'}}};
  for (const auto& [name, letter] : kLetters) {
    if (word != name) continue;
    column->channel.assign(1, letter);
    return true;
  }
  const std::optional<double> nm = WavelengthOf(word, *column);
  if (nm) SetWavelength(*nm, column);
  return nm.has_value();
}

// "U (k=2)", "2 sigma", "relative uncertainty", "u_rel": how far a number of uncertainty is from a standard deviation.
bool ClassifySpread(const NameWords& name, CsvColumn* column) {
  NameList rest;
  // "U_BRDF" is the expanded one beside "u_BRDF", as the GUM writes them.
  const bool letter =
      column->name.size() > 1 && column->name[0] == 'U' && (column->name[1] == '_' || column->name[1] == ' ');
  bool spread = Joined(name.words) == "s_d", expanded = name.function == "U" || letter,
       standard = name.function == "u" || name.function == "s";
  for (std::size_t i = 0; i < name.words.size(); ++i) {
    const std::string_view word = name.words[i];
    const bool last_number = word.size() == 1 && word[0] >= '1' && word[0] <= '9';
    if (HoldsWord(kSpread, word) || word == "variance" || word == "var" || word == "ubrdf" || word == "ubsdf") {
      spread = true;
      column->variance = column->variance || word == "variance" || word == "var";
      column->relative = column->relative || word == "rsd";
    } else if (word == "relative" || word == "rel" || word == "cv") {
      column->relative = true;
      spread = spread || word == "cv";
    } else if (word == "expanded" || word == "erweiterte") {
      expanded = spread = true;
    } else if (word == "k" && i + 1 < name.words.size()) {
      const std::optional<double> k = ParseDouble(name.words[i + 1]);
      if (!k || !(*k > 0)) return false;
      column->coverage_factor = *k;
      ++i;
    } else if (last_number && i + 1 < name.words.size() && name.words[i + 1] == "sigma") {
      column->coverage_factor = word[0] - '0';
    } else if ((word == "2sigma" || word == "3sigma")) {
      column->coverage_factor = word[0] - '0';
      spread = true;
    } else if (word == "standard" || word == "combined" || word == "c" || word == "typ" || word == "measurement" ||
               word == "dev" || word == "bar" || word == "bars" || HoldsWord(kFillers, word) ||
               FindValue(word) != nullptr || word == "%") {
      if (word == "%") column->unit = "%";
    } else {
      rest.emplace_back(word);
    }
  }
  static constexpr std::array<std::string_view, 5> kFunctions = {"u", "U", "s", "sigma", "std"};
  spread =
      spread || standard || HoldsWord(kFunctions, name.function) || name.function == "unc" || name.function == "stdev";
  if (!spread) return false;
  if (Joined(rest) == "s_d") rest.clear();
  // "u AOI=10", "30 deg err": of the values at that angle.
  CsvColumn at;
  if (!rest.empty() && !(rest.size() == 2 && FindValue(Joined(rest)) != nullptr) && !ClassifyChannel(rest, column)) {
    if (!ClassifyFixed(rest, &at)) return false;
    column->fixed = at.fixed;
    column->unit.clear();  // that of the angle
  }
  column->role = ColumnRole::kSigma;
  if (expanded && column->coverage_factor == 1 &&
      std::find(name.words.begin(), name.words.end(), "k") == name.words.end()) {
    column->problem = "is an expanded uncertainty whose factor k is not said; write it as 'U (k=2)'";
  }
  return true;
}

bool ClassifyValue(const NameWords& name, CsvColumn* column) {
  if (!name.function.empty() && !name.function.starts_with("l") && !name.function.starts_with("10") &&
      name.function != "db")
    return false;
  NameList words = WithoutFillers(name.words);
  // "log10_brdf", "10log10(f)", "dB": the scale in front of the value.
  std::string scale = name.function;
  if (words.size() > 1 &&
      (words[0] == "log10" || words[0] == "ln" || words[0] == "log" || words[0] == "lg" || words[0] == "10log10")) {
    scale = words[0];
    words.erase(words.begin());
  }
  // A white standard diffuses nearly all light: what is related to it is pi f_r.
  const std::size_t before = words.size();
  std::erase_if(words, [](const std::string& word) { return HoldsWord(kWhiteStandards, word); });
  const bool to_white = words.size() < before;
  if (to_white) {
    std::erase_if(words, [](const std::string& word) { return HoldsWord(kRelatedTo, word); });
    const std::string rest = Joined(words);
    if (rest != "reflectance" && rest != "reflectance_factor" && rest != "radiance_factor" && rest != "brf")
      return false;
    column->role = ColumnRole::kValue;
    column->value_kind = ValueKind::kReflectanceFactor;
    return true;
  }
  const std::string whole = Joined(words);
  const std::string_view joined = whole;
  const ValueName* value = FindValue(joined);
  if (value == nullptr && name.words != words) value = FindValue(Joined(name.words));
  if (value != nullptr) {
    column->role = ColumnRole::kValue;
    column->value_kind = value->kind;
  } else if (joined == "q" && (name.unit.starts_with("cd") || name.unit.starts_with("mcd"))) {
    column->role = ColumnRole::kValue;  // of a road surface
    column->value_kind = ValueKind::kBrdf;
  } else if (joined == "i_f" || joined == "radf" || joined == "iof" || joined == "io_f") {
    column->role = ColumnRole::kValue;
    column->value_kind = ValueKind::kReflectanceCosI;
  } else if (joined == "reflectance" || joined == "reflectivity" || joined == "refl" || joined == "reflexion" ||
             joined == "reflectances" || joined == "bdr" || joined == "reflectancia" || joined == "riflettanza" ||
             joined == "refletancia" || joined == "reflektanz" || joined == "reflexionsgrad" || joined == "rho" ||
             (joined == "scatter" && !ParseAngleUnit(name.unit)) || joined == "brdf_cos" || joined == "bsdf_cos" ||
             joined == "f_cos" || joined == "fr_cos" || joined == "cos_brdf" || joined == "cosine_brdf" ||
             joined == "cosine_weighted_brdf") {
    column->role = ColumnRole::kOtherValue;
  } else {
    return false;
  }
  if (scale == "log") {
    column->problem =
        "has a logarithm of which the base is not said; name it log10 or ln, or say it with --value-scale";
  } else if (!scale.empty() && scale != "u" && scale != "s") {
    column->value_scale = ParseValueScale(scale);
  }
  return true;
}

bool NamesValue(const std::string& joined, std::optional<ValueKind>* kind) {
  const ValueName* value = FindValue(joined);
  if (value != nullptr) *kind = value->kind;
  return value != nullptr;
}

std::size_t FindPossibleValue(const std::vector<CsvColumn>& columns) {
  std::size_t possible = columns.size();
  for (std::size_t i = columns.size(); i-- > 0;) {
    const NameList words = SplitName(columns[i].name).words;
    const bool value = std::any_of(words.begin(), words.end(), [](const std::string& word) {
      return word.size() > 2 && FindValue(word) != nullptr;
    });
    if (value && columns[i].role == ColumnRole::kUnknown) possible = i;
  }
  for (std::size_t i = columns.size(); i-- > 0;) {
    if (columns[i].role == ColumnRole::kOtherValue && SplitName(columns[i].name).words.size() < 3) possible = i;
  }
  return possible;
}

bool ClassifyValueOfChannel(const NameList& words, CsvColumn* column) {
  if (words.size() < 2) return false;
  // "f_r 633" is no channel r of f.
  for (std::size_t length = words.size() - 1; length > 0; --length) {
    const auto count = static_cast<std::ptrdiff_t>(length);
    for (const bool first : {true, false}) {
      const NameList value =
          first ? NameList(words.begin(), words.begin() + count) : NameList(words.end() - count, words.end());
      const NameList rest =
          first ? NameList(words.begin() + count, words.end()) : NameList(words.begin(), words.end() - count);
      std::optional<ValueKind> kind;
      if (!NamesValue(Joined(value), &kind) || !ClassifyChannel(rest, column)) continue;
      column->value_kind = kind;
      return true;
    }
  }
  return false;
}

}  // namespace lobefit
