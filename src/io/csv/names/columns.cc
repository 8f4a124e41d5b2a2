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

// Whole names, joined by "_", that are none of the grammar's.
struct Synonym {
  std::string_view name;
  ColumnRole role;
  Coordinate coordinate = Coordinate::kThetaI;
};
constexpr std::array<Synonym, 56> kSynonyms = {{
    {"emi", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"pha", ColumnRole::kCoordinate, Coordinate::kPhase},
    {"aoi", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"incidence", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"incident", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"inc", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"einfallswinkel", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"sza", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"iza", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"saa", ColumnRole::kCoordinate, Coordinate::kPhiI},
    {"iaa", ColumnRole::kCoordinate, Coordinate::kPhiI},
    {"vza", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"oza", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"receive", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"emission", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"emergence", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"viewing", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"ausfallswinkel", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"streuwinkel", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"beobachtungswinkel", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"detektorwinkel", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"reflexionswinkel", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"aor", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"aov", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"aos", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"vaa", ColumnRole::kCoordinate, Coordinate::kPhiO},
    {"oaa", ColumnRole::kCoordinate, Coordinate::kPhiO},
    {"raa", ColumnRole::kCoordinate, Coordinate::kDeltaPhi},
    {"dphi", ColumnRole::kCoordinate, Coordinate::kDeltaPhi},
    {"dazimuth", ColumnRole::kCoordinate, Coordinate::kDeltaPhi},
    {"phase", ColumnRole::kCoordinate, Coordinate::kPhase},
    {"phase_angle", ColumnRole::kCoordinate, Coordinate::kPhase},
    {"delta_theta", ColumnRole::kCoordinate, Coordinate::kFromSpecular},
    {"dtheta", ColumnRole::kCoordinate, Coordinate::kFromSpecular},
    {"aspecular", ColumnRole::kCoordinate, Coordinate::kFromSpecular},
    {"aspecular_angle", ColumnRole::kCoordinate, Coordinate::kFromSpecular},
    {"bistatic", ColumnRole::kCoordinate, Coordinate::kBistatic},
    {"bistatic_angle", ColumnRole::kCoordinate, Coordinate::kBistatic},
    {"deviation_angle", ColumnRole::kCoordinate, Coordinate::kDeviation},
    {"angle_of_deviation", ColumnRole::kCoordinate, Coordinate::kDeviation},
    {"total_deviation", ColumnRole::kCoordinate, Coordinate::kDeviation},
    {"total_deviation_angle", ColumnRole::kCoordinate, Coordinate::kDeviation},
    {"beta_0", ColumnRole::kCoordinate, Coordinate::kBeta0},
    {"beta", ColumnRole::kCoordinate, Coordinate::kBeta},
    {"beta_s", ColumnRole::kCoordinate, Coordinate::kBeta},
    {"beta_beta_0", ColumnRole::kCoordinate, Coordinate::kBetaOffset},
    {"b_b0", ColumnRole::kCoordinate, Coordinate::kBetaOffset},
    {"delta_beta", ColumnRole::kCoordinate, Coordinate::kBetaOffset},
    {"dbeta", ColumnRole::kCoordinate, Coordinate::kBetaOffset},
    {"sample_rotation", ColumnRole::kCoordinate, Coordinate::kSampleRotation},
    {"rotation", ColumnRole::kCoordinate, Coordinate::kSampleRotation},
    {"sample_azimuth", ColumnRole::kCoordinate, Coordinate::kSampleRotation},
    {"stage_rotation", ColumnRole::kCoordinate, Coordinate::kSampleRotation},
    {"weight", ColumnRole::kWeight},
    {"weights", ColumnRole::kWeight},
    {"fr_authors_formula", ColumnRole::kOtherValue},
}};

constexpr std::array<std::string_view, 55> kIgnored = {"index",
                                                       "id",
                                                       "no",
                                                       "nr",
                                                       "row",
                                                       "rows",
                                                       "n",
                                                       "num",
                                                       "number",
                                                       "#",
                                                       "point",
                                                       "time",
                                                       "date",
                                                       "datetime",
                                                       "timestamp",
                                                       "temperature",
                                                       "temp",
                                                       "humidity",
                                                       "comment",
                                                       "comments",
                                                       "remark",
                                                       "remarks",
                                                       "note",
                                                       "notes",
                                                       "operator",
                                                       "file",
                                                       "filename",
                                                       "l_o_raw",
                                                       "radiance",
                                                       "irradiance",
                                                       "raw",
                                                       "counts",
                                                       "signal",
                                                       "dark",
                                                       "reference",
                                                       "gain",
                                                       "exposure",
                                                       "exposure_time",
                                                       "integration_time",
                                                       "power",
                                                       "distance",
                                                       "solid_angle",
                                                       "aperture",
                                                       "user",
                                                       "sample",
                                                       "material",
                                                       "status",
                                                       "flag",
                                                       "scan",
                                                       "step",
                                                       "unnamed",
                                                       "unnamed_0",
                                                       "voltage",
                                                       "current",
                                                       "background"};

// Short names of angles that mean nothing else.
constexpr std::array<std::string_view, 18> kAngleShorthands = {"aoi", "aor",  "aos",    "aov",      "sza",       "iza",
                                                               "saa", "iaa",  "vza",    "oza",      "vaa",       "oaa",
                                                               "raa", "dphi", "dtheta", "dazimuth", "aspecular", "psi"};

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

// "cos_sza"
bool IsCosineOfSynonym(std::string_view joined, CsvColumn* column) {
  if (!joined.starts_with("cos_")) return false;
  const auto* synonym =
      std::find_if(kSynonyms.begin(), kSynonyms.end(), [&](const Synonym& s) { return s.name == joined.substr(4); });
  if (synonym == kSynonyms.end() || synonym->role != ColumnRole::kCoordinate ||
      (synonym->coordinate != Coordinate::kThetaI && synonym->coordinate != Coordinate::kThetaO))
    return false;
  column->role = ColumnRole::kCoordinate;
  column->coordinate = synonym->coordinate;
  column->form = AngleForm::kCosine;
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

void ParseUnit(CsvColumn* column) {
  const std::string& unit = column->unit;
  if (unit.empty()) return;
  const auto refuse = [&](const std::string& allowed) {
    if (column->problem.empty())
      column->problem = "has the unit '" + Excerpt(unit) + "', which is not known; allowed are " + allowed;
  };
  switch (column->role) {
    case ColumnRole::kCoordinate:
    case ColumnRole::kFixed: {
      const bool cosine = (column->coordinate >= Coordinate::kWiX && column->coordinate <= Coordinate::kWoZ) ||
                          column->form == AngleForm::kCosine;
      const bool sine = column->coordinate == Coordinate::kBeta || column->coordinate == Coordinate::kBeta0 ||
                        column->coordinate == Coordinate::kBetaOffset;
      if (cosine || sine) break;
      column->angle_unit = ParseAngleUnit(unit);
      if (!column->angle_unit)
        refuse(
            unit == "grad"
                ? "deg, rad, gon, mrad (grad is read as deg by some and as gon by others: say which with --angle-unit)"
                : "deg, rad, gon, mrad, arcmin, arcsec");
      break;
    }
    case ColumnRole::kWavelength:
      column->wavelength_unit = ParseWavelengthUnit(unit);
      if (!column->wavelength_unit) refuse("nm, um, mm, m, A, cm^-1, eV, THz, GHz");
      break;
    case ColumnRole::kValue:
    case ColumnRole::kOtherValue:
      if (column->value_scale) {
        const std::optional<ValueScale> own = ParseValueScale(unit);
        if (!own || (own->form != ValueScale::Form::kLinear && own->form != column->value_scale->form)) {
          refuse("1/sr");
        } else if (own->form == ValueScale::Form::kLinear) {
          column->value_scale->factor *= own->factor;
        }
        break;
      }
      column->value_scale = ParseValueScale(unit);
      if (!column->value_scale && column->role == ColumnRole::kValue)
        refuse("1/sr, %, dB, log10, ln, a power of ten as in 1e-3/sr, a.u.");
      break;
    case ColumnRole::kChannel:
      // That of a wavelength in the name.
      if (column->wavelength_nm > 0 && ParseWavelengthUnit(unit)) break;
      column->value_scale = ParseValueScale(unit);
      if (!column->value_scale) refuse("1/sr, %, dB, log10, ln, a power of ten as in 1e-3/sr, a.u.");
      break;
    case ColumnRole::kSigma:
      if (unit == "%" || unit == "percent") column->relative = true;
      // "k=2" below "U".
      if (unit.starts_with("k=") && ParseDouble(std::string_view(unit).substr(2)).value_or(0) > 0) {
        column->coverage_factor = *ParseDouble(std::string_view(unit).substr(2));
        column->problem.clear();
        column->unit.clear();
      } else if (unit == "ppm" || unit == "rel" || unit == "rel.") {
        column->relative = true;
      } else if (!column->relative && !ParseValueScale(unit)) {
        refuse("1/sr, %, ppm, dB, a power of ten as in 1e-3/sr");
      }
      break;
    default:
      break;
  }
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
  const auto* synonym =
      std::find_if(kSynonyms.begin(), kSynonyms.end(), [&](const Synonym& s) { return SameWord(s.name, joined); });
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
  if (may_be_fixed && equals &&
      attempt([&](CsvColumn* c) { return ClassifyFixed(split.words, c) && c->role == ColumnRole::kFixed; })) {
  } else if (plain && synonym != kSynonyms.end()) {
    column.role = synonym->role;
    column.coordinate = synonym->coordinate;
    column.magnitude = split.magnitude;
    // 45as15 is 15 degrees from the mirror direction towards the light (ASTM E2194, DIN 6175-2).
    column.reversed = column.aspecular = joined.starts_with("aspecular");
  } else if (plain && IsCosineOfSynonym(joined, &column)) {
  } else if (attempt([&](CsvColumn* c) { return ClassifyValue(split, c); })) {
  } else if (attempt([&](CsvColumn* c) { return ClassifySpread(split, c); })) {
  } else if (plain && attempt([&](CsvColumn* c) { return ClassifyPolarisation(split.words, c); })) {
  } else if (plain && attempt([&](CsvColumn* c) {
               return ClassifyChannel(split.words, c) && (c->role = ColumnRole::kChannel, true);
             })) {
  } else if (plain && attempt([&](CsvColumn* c) { return ClassifyWavelengthColumn(meaning, c); })) {
  } else if (plain && attempt([&](CsvColumn* c) { return ClassifyAngle(meaning, split.magnitude, c); })) {
  } else if (plain && attempt([&](CsvColumn* c) { return ClassifyComponent(split.words, c); })) {
  } else if (plain && attempt([&](CsvColumn* c) {
               return ClassifyValueOfChannel(split.words, c) && (c->role = ColumnRole::kChannel, true);
             })) {
  } else if (may_be_fixed && attempt([&](CsvColumn* c) { return ClassifyFixed(split.words, c); })) {
  } else if (HoldsWord(kIgnored, joined) || IsMuellerRatio(split.words)) {
    column.role = ColumnRole::kIgnored;
  }
  ParseUnit(&column);
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
  ParseUnit(column);
}

bool LooksLikeAngle(const CsvColumn& column) {
  if (column.role != ColumnRole::kUnknown) return false;
  const NameWords split = SplitName(column.name);
  if (ParseAngleUnit(column.unit)) return true;
  // "dphi [turn]": the words without the unit that is not known are an angle's.
  return std::any_of(split.words.begin(), split.words.end(), [](const std::string& word) {
    return IsAngleWord(word) || ParseAngleUnit(word).has_value() || HoldsWord(kAngleShorthands, word);
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
