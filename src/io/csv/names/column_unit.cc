#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/names/name_rules.h"

namespace lobefit {

void ParseColumnUnit(CsvColumn* column) {
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

}  // namespace lobefit
