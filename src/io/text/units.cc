#include "lobefit/io/text/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "lobefit/base/text/same_word.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

template <class Value>
struct Spelling {
  std::string_view word;
  Value value;
};

template <class Table>
auto FindSpelling(const Table& table, std::string_view word) -> std::optional<decltype(table[0].value)> {
  for (const auto& entry : table) {
    if (SameWord(entry.word, word)) return entry.value;
  }
  return std::nullopt;
}

constexpr std::array<Spelling<AngleUnit>, 34> kAngles = {{
    {"deg.", AngleUnit::kDegrees},
    {"rad.", AngleUnit::kRadians},
    {"deg", AngleUnit::kDegrees},
    {"degs", AngleUnit::kDegrees},
    {"degree", AngleUnit::kDegrees},
    {"degrees", AngleUnit::kDegrees},
    {"degr", AngleUnit::kDegrees},
    {"grados", AngleUnit::kDegrees},
    {"gradi", AngleUnit::kDegrees},
    {"degres", AngleUnit::kDegrees},
    {"degre", AngleUnit::kDegrees},
    {"graus", AngleUnit::kDegrees},
    {"graden", AngleUnit::kDegrees},
    {"grader", AngleUnit::kDegrees},
    {"stopnie", AngleUnit::kDegrees},
    {"stupne", AngleUnit::kDegrees},
    {"radianes", AngleUnit::kRadians},
    {"radianti", AngleUnit::kRadians},
    {"rad", AngleUnit::kRadians},
    {"rads", AngleUnit::kRadians},
    {"radian", AngleUnit::kRadians},
    {"radians", AngleUnit::kRadians},
    {"radiant", AngleUnit::kRadians},
    {"gon", AngleUnit::kGon},
    {"gons", AngleUnit::kGon},
    {"gradian", AngleUnit::kGon},
    {"gradians", AngleUnit::kGon},
    {"mrad", AngleUnit::kMilliradians},
    {"milliradians", AngleUnit::kMilliradians},
    {"mrads", AngleUnit::kMilliradians},
    {"arcmin", AngleUnit::kArcMinutes},
    {"arcminutes", AngleUnit::kArcMinutes},
    {"arcsec", AngleUnit::kArcSeconds},
    {"arcseconds", AngleUnit::kArcSeconds},
}};

constexpr std::array<Spelling<WavelengthUnit>, 26> kWavelengths = {{
    {"nm", {1, false, "nm"}},
    {"nanometer", {1, false, "nm"}},
    {"nanometers", {1, false, "nm"}},
    {"nanometres", {1, false, "nm"}},
    {"um", {1e3, false, "um"}},
    {"micron", {1e3, false, "um"}},
    {"microns", {1e3, false, "um"}},
    {"micrometers", {1e3, false, "um"}},
    {"micrometres", {1e3, false, "um"}},
    {"mm", {1e6, false, "mm"}},
    {"m", {1e9, false, "m"}},
    {"a", {0.1, false, "A"}},
    {"angstrom", {0.1, false, "A"}},
    {"cm^-1", {1e7, true, "cm^-1"}},
    {"cm-1", {1e7, true, "cm^-1"}},
    {"1/cm", {1e7, true, "cm^-1"}},
    {"/cm", {1e7, true, "cm^-1"}},
    // h c = 1239.841984 eV nm and c = 299792.458 THz nm, both exact in the SI of 2019 to the digits given.
    {"ev", {1239.841984332, true, "eV"}},
    {"thz", {299792.458, true, "THz"}},
    {"ghz", {299792458.0, true, "GHz"}},
    {"hz", {299792458e9, true, "Hz"}},
    {"1/m", {1e9, true, "m^-1"}},
    {"m^-1", {1e9, true, "m^-1"}},
    {"m-1", {1e9, true, "m^-1"}},
    {"1/um", {1e3, true, "um^-1"}},
    {"um^-1", {1e3, true, "um^-1"}},
}};

// A factor before a unit: "1e-3/sr", "10^-3sr^-1". The rest of the unit goes to `rest`. A factor behind a times sign is
// not taken: some mean by "x 1000" that the numbers are to be multiplied, some that they have been.
std::optional<double> Factor(std::string_view unit, std::string_view* rest) {
  double base = 0;
  if (unit.starts_with("10^") || unit.starts_with("10**")) {
    unit.remove_prefix(unit[2] == '^' ? 3 : 4);
    base = 10;
  }
  std::size_t length = 0;
  for (std::size_t n = unit.size(); n > 0 && length == 0; --n) {
    if (unit[n - 1] >= '0' && unit[n - 1] <= '9' && ParseDouble(unit.substr(0, n))) length = n;
  }
  if (length == 0) return std::nullopt;
  const double number = *ParseDouble(unit.substr(0, length));
  *rest = unit.substr(length);
  if (rest->starts_with("*") || rest->starts_with(".")) rest->remove_prefix(1);
  const double factor = base > 0 ? std::pow(base, number) : number;
  return std::isfinite(factor) && factor > 0 ? std::optional(factor) : std::nullopt;
}

}  // namespace

bool IsPerSteradian(std::string_view unit) {
  // Of a luminance coefficient cd m^-2 lx^-1, which is the same.
  static constexpr std::array<std::string_view, 19> kSpellings = {
      "1/sr",      "/sr",      "sr^-1",     "sr-1",        "sr^(-1)",      "sr**-1",       "persr",
      "1/ster",    "ster^-1",  "invsr",     "1/steradian", "persteradian", "steradian^-1", "inversesteradian",
      "inversesr", "cd/m2/lx", "cd/m^2/lx", "cd/(m2*lx)",  "cd*m^-2*lx^-1"};
  return std::any_of(kSpellings.begin(), kSpellings.end(),
                     [&](std::string_view known) { return SameWord(known, unit); });
}

double ValueScale::Apply(double number) const {
  switch (form) {
    case Form::kLinear:
      return factor * number;
    case Form::kLog10:
      return factor * std::pow(10.0, number);
    case Form::kLn:
      return factor * std::exp(number);
    case Form::kDecibel:
      return factor * std::pow(10.0, number / 10);
  }
  return number;
}

double ValueScale::Slope(double number) const {
  constexpr double kLn10 = 2.302585092994045684;
  switch (form) {
    case Form::kLinear:
      return factor;
    case Form::kLog10:
      return kLn10 * Apply(number);
    case Form::kLn:
      return Apply(number);
    case Form::kDecibel:
      return kLn10 / 10 * Apply(number);
  }
  return 1;
}

std::string PlainUnit(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 31> kSigns = {{
      // The degree sign of UTF-8 taken for Windows-1252, of DOS and of old Macs taken for it, and what stands for a
      // sign that was lost.
      {"\u00c2\u00b0", "deg"},
      {"\u00f8", "deg"},
      {"\u00a1", "deg"},
      {"\ufffd", "deg"},
      {"\xc2\xb5", "u"},       // micro sign
      {"\xce\xbc", "u"},       // Greek mu
      {"\xc2\xb0", "deg"},     // degree sign
      {"\xc2\xba", "deg"},     // masculine ordinal
      {"\xcb\x9a", "deg"},     // ring above
      {"\xe2\x81\xbb", "^-"},  // superscript minus
      {"\xc2\xaf", "^-"},      // macron, as superscript minus
      {"\xc2\xb9", "1"},       // superscript one
      {"\xc2\xb2", "2"},       // superscript two
      {"\xc2\xb3", "3"},       // superscript three
      {"\xe2\x88\x92", "-"},   // minus
      {"\xe2\x80\x93", "-"},   // en dash
      {"\xe2\x80\x90", "-"},   // hyphen
      {"\xc2\xb7", "*"},       // middle dot
      {"\xe2\x8b\x85", "*"},   // dot operator
      {"\xc3\x97", "x"},       // times
      {"\xc3\x85", "a"},       // A with ring, angstrom
      {"\xe2\x84\xab", "a"},   // angstrom sign
      {"\xc3\xa9", "e"},       // e acute
      {"\xc3\xa8", "e"},       // e grave
      {"\xc2\xa0", ""},        // no-break space
      {"\xe2\x80\xaf", ""},    // narrow no-break space
      {"\xe2\x80\xb0", "permille"},
      {"{", ""},
      {"}", ""},
      {"$", ""},
      {"\\", ""},
  }};
  static constexpr ByFirstByte<kSigns.size()> kSignsByByte(kSigns, [](const auto& sign) { return sign.first; });
  std::string plain;
  bool apart = false;  // a blank before
  while (!unit.empty()) {
    const char c = unit.front();
    // Names and keys of a file's head are asked for their unit dozens of times.
    const std::size_t found = kSignsByByte.Find(unit, [&](std::size_t i) { return unit.starts_with(kSigns[i].first); });
    if (found < kSigns.size()) {
      plain += kSigns[found].second;
      unit.remove_prefix(kSigns[found].first.size());
      continue;
    }
    unit.remove_prefix(1);
    // "1e-3 1/sr" is a product, not 1e-31.
    const bool between = IsDigit(c) && apart && !plain.empty() && IsDigit(plain.back());
    if (between) plain += '*';
    apart = c == ' ' || c == '\t';
    if (!apart) plain += c;
  }
  return ToLower(plain);
}

std::optional<AngleUnit> ParseAngleUnit(std::string_view unit) { return FindSpelling(kAngles, PlainUnit(unit)); }

std::optional<ValueScale> ParseValueScale(std::string_view unit) {
  using Form = ValueScale::Form;
  const std::string plain = PlainUnit(unit);
  std::string_view rest = plain;
  if (rest.empty() || rest == "1" || rest == "-" || rest == "none" || rest == "linear" || IsPerSteradian(rest))
    return ValueScale{};
  for (const std::string_view word :
       {"a.u.", "au",  "a.u", "arb", "arb.", "arb.u.", "arb.units",  "arbitraryunits", "arbitrary", "counts", "count",
        "cts",  "adu", "dn",  "v",   "mv",   "na",     "normalized", "normalised",     "rel.",      "rel.u.", "rel"}) {
    if (SameWord(rest, word)) return ValueScale{Form::kLinear, 1, true};
  }
  Form form = Form::kLinear;
  for (const auto& [word, its] : {std::pair{std::string_view("10log10"), Form::kDecibel},
                                  {"10*log10", Form::kDecibel},
                                  {"log10", Form::kLog10},
                                  {"lg", Form::kLog10},
                                  {"ln", Form::kLn},
                                  {"decibel", Form::kDecibel},
                                  {"db", Form::kDecibel}}) {
    if (!BeginsWith(rest, word)) continue;
    form = its;
    rest.remove_prefix(word.size());
    break;
  }
  if (form != Form::kLinear) {
    while (!rest.empty() && (rest.front() == '(' || rest.front() == '*' || rest.front() == ',')) rest.remove_prefix(1);
    while (!rest.empty() && rest.back() == ')' && rest.front() != '(' && !rest.ends_with("(-1)")) rest.remove_suffix(1);
    if (rest.empty() || IsPerSteradian(rest)) return ValueScale{form, 1, false};
    return std::nullopt;
  }
  for (const auto& [word, factor] : {std::pair{std::string_view("%"), 0.01},
                                     {"percent", 0.01},
                                     {"pct", 0.01},
                                     {"prozent", 0.01},
                                     {"permille", 0.001}}) {
    if (!BeginsWith(rest, word)) continue;
    rest.remove_prefix(word.size());
    if (rest.starts_with("*") || rest.starts_with("/sr")) rest.remove_prefix(rest[0] == '*' ? 1 : 0);
    if (rest.empty() || IsPerSteradian(rest)) return ValueScale{Form::kLinear, factor, false};
    return std::nullopt;
  }
  if (rest.starts_with("mcd") && IsPerSteradian(rest.substr(1))) return ValueScale{Form::kLinear, 1e-3, false};
  if (rest == "msr^-1" || rest == "1/msr" || rest == "/msr" || rest == "msr-1")
    return ValueScale{Form::kLinear, 1e3, false};
  const std::optional<double> factor = Factor(plain, &rest);
  if (factor && (rest.empty() || IsPerSteradian(rest))) return ValueScale{Form::kLinear, *factor, false};
  return std::nullopt;
}

std::optional<WavelengthUnit> ParseWavelengthUnit(std::string_view unit) {
  return FindSpelling(kWavelengths, PlainUnit(unit));
}

double RadiansPerUnit(AngleUnit unit) {
  switch (unit) {
    case AngleUnit::kDegrees:
      return kPi / 180;
    case AngleUnit::kRadians:
      return 1;
    case AngleUnit::kGon:
      return kPi / 200;
    case AngleUnit::kMilliradians:
      return 1e-3;
    case AngleUnit::kArcMinutes:
      return kPi / (180.0 * 60);
    case AngleUnit::kArcSeconds:
      return kPi / (180.0 * 3600);
  }
  return 1;
}

}  // namespace lobefit
