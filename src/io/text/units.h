// Units as people write them in column names, rows of units and keys: understood, or nothing, so that the caller
// refuses.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lobefit/io/text/format.h"

namespace lobefit {

// How a stored number stands for a value: value = factor * number, or factor * base^(number / step).
struct ValueScale {
  enum class Form { kLinear, kLog10, kLn, kDecibel };
  Form form = Form::kLinear;
  double factor = 1;
  bool arbitrary = false;  // "a.u.", "counts": the factor to 1/sr is not known

  double Apply(double number) const;
  // d value / d number, which carries a standard deviation across.
  double Slope(double number) const;
  bool IsIdentity() const { return form == Form::kLinear && factor == 1; }
};

struct WavelengthUnit {
  double nm = 1;            // of one unit; of the reciprocal where `reciprocal`
  bool reciprocal = false;  // a wavenumber, a photon energy or a frequency
  std::string_view name = "nm";

  double ToNm(double number) const { return reciprocal ? nm / number : nm * number; }
};

// Lower case, without blanks; signs that only Unicode has become those of ASCII: "sr⁻¹" is "sr^-1", "µm" is "um", the
// degree sign and the ordinal that is taken for it are "deg". Numbers with a blank between are a product, "1e-3*1/sr".
std::string PlainUnit(std::string_view unit);

// deg, rad, gon, mrad, arcmin, arcsec and their spellings. "grad" is German for deg and English for gon, so it is
// neither.
std::optional<AngleUnit> ParseAngleUnit(std::string_view unit);
// 1/sr and its spellings, nothing or 1 for a reflectance factor, %, dB, log10, ln, a power of ten (as in "1e-3/sr"),
// a.u. and counts.
std::optional<ValueScale> ParseValueScale(std::string_view unit);
// Spellings of 1/sr, as PlainUnit gives them.
bool IsPerSteradian(std::string_view unit);
// nm, um, mm, m, A; wavenumbers (cm^-1, m^-1, um^-1), eV, THz, GHz, Hz.
std::optional<WavelengthUnit> ParseWavelengthUnit(std::string_view unit);

double RadiansPerUnit(AngleUnit unit);

}  // namespace lobefit
