#include "lobefit/io/csv/columns.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lobefit/base/text.h"

namespace lobefit {
namespace {

struct Synonyms {
  ColumnRole role;
  std::optional<ValueKind> kind;
  std::vector<std::string_view> names;
};

const std::vector<Synonyms>& Table() {
  static const std::vector<Synonyms> table = {
      {ColumnRole::kThetaI,
       {},
       {"theta_i", "thetai", "theta_in", "theta_inc", "theta_l", "inc", "incidence", "incidence_angle", "aoi"}},
      {ColumnRole::kPhiI, {}, {"phi_i", "phii", "phi_in", "phi_inc", "phi_l", "phi"}},
      {ColumnRole::kThetaO,
       {},
       {"theta_o", "thetao", "theta_r", "thetar", "theta_s", "thetas", "theta_v", "thetav", "theta_out", "receive"}},
      {ColumnRole::kPhiO, {}, {"phi_o", "phio", "phi_r", "phir", "phi_s", "phis", "phi_v", "phiv", "phi_out"}},
      {ColumnRole::kDeltaPhi, {}, {"dphi", "delta_phi", "deltaphi"}},
      {ColumnRole::kAzimuth, {}, {"azimuth"}},
      {ColumnRole::kWavelength, {}, {"wavelength", "lambda", "wavelength_nm", "lambda_nm", "wavelength_um"}},
      {ColumnRole::kValue, {}, {"value"}},
      {ColumnRole::kValue, ValueKind::kBrdf, {"f", "fr", "f_r", "brdf", "bsdf", "f_r11", "fr_l_over_e"}},
      {ColumnRole::kValue, ValueKind::kBrdfCosO, {"f_cos_o", "brdf_cos_o", "ccbrdf"}},
      {ColumnRole::kValue, ValueKind::kBrdfCosI, {"f_cos_i", "brdf_cos_i"}},
      {ColumnRole::kValue, ValueKind::kReflectanceFactor, {"pi_f", "brf", "reflectance_factor"}},
      {ColumnRole::kValue, ValueKind::kIntensity, {"intensity"}},
      {ColumnRole::kValue, ValueKind::kReading, {"rt"}},
      {ColumnRole::kOtherValue, ValueKind::kBrdf, {"fr_authors_formula"}},
      {ColumnRole::kSigma, {}, {"sigma", "std", "stddev", "uncertainty"}},
      {ColumnRole::kWeight, {}, {"weight"}},
      {ColumnRole::kIgnored,
       {},
       {"index", "id", "no", "row", "time", "date", "temperature", "comment", "l_o_raw", "radiance", "irradiance",
        "raw", "counts", "signal"}},
  };
  return table;
}

// "L_o_raw(W/m2/sr)" -> "l_o_raw" and the unit "w/m2/sr"; "theta_i_deg" -> "theta_i" and "deg".
std::string_view StripUnit(std::string_view name, std::string_view* unit) {
  for (const auto& [open, close] : {std::pair{'(', ')'}, std::pair{'[', ']'}}) {
    const std::size_t at = name.find(open);
    if (at == std::string_view::npos || at == 0 || name.back() != close) continue;
    *unit = Trim(name.substr(at + 1, name.size() - at - 2));
    name = Trim(name.substr(0, at));
  }
  for (const std::string_view suffix : {"_deg", "_rad", "_degrees", "_radians"}) {
    if (name.size() > suffix.size() && name.ends_with(suffix)) {
      *unit = suffix.substr(1);
      name.remove_suffix(suffix.size());
      break;
    }
  }
  return name;
}

// "550nm", "550 nm", "0.55um", "lambda=550", "550".
std::optional<double> WavelengthOf(std::string_view name) {
  if (name.starts_with("lambda=")) name.remove_prefix(7);
  double scale = 1;
  bool unit = false;
  if (name.ends_with("nm")) {
    name.remove_suffix(2);
    unit = true;
  } else if (name.ends_with("um")) {
    name.remove_suffix(2);
    scale = 1000;
    unit = true;
  }
  const std::optional<double> number = ParseDouble(name);
  if (!number || !std::isfinite(*number) || *number <= 0) return std::nullopt;
  // A bare number is a wavelength only where it can be one in nanometres.
  if (!unit && (*number < 100 || *number > 20000)) return std::nullopt;
  return *number * scale;
}

void SetWavelength(double nm, CsvColumn* column) {
  column->wavelength_nm = nm;
  column->channel = FormatDouble(nm) + "nm";
}

// A name of a channel, as used by itself and after "sigma_".
bool ClassifyChannel(std::string_view lower, CsvColumn* column) {
  for (const std::string_view channel : {"r", "g", "b", "x", "y", "z"}) {
    if (lower == channel) {
      column->channel.assign(1, static_cast<char>(channel[0] - 'a' + 'A'));
      return true;
    }
  }
  const std::optional<double> nm = WavelengthOf(lower);
  if (nm) SetWavelength(*nm, column);
  return nm.has_value();
}

// Ratios of Mueller matrix elements beside f_r11, as in "f_r12/f_r11": the polarised part, which f_r does not need.
bool IsMuellerRatio(std::string_view lower) {
  return lower.size() == 11 && lower.starts_with("f_r") && lower.ends_with("/f_r11");
}

bool IsAngle(ColumnRole role) {
  return role == ColumnRole::kThetaI || role == ColumnRole::kPhiI || role == ColumnRole::kThetaO ||
         role == ColumnRole::kPhiO || role == ColumnRole::kDeltaPhi || role == ColumnRole::kAzimuth;
}

}  // namespace

CsvColumn ClassifyColumn(std::string_view name) {
  CsvColumn column;
  column.name = std::string(Trim(name));
  const std::string lower_case = ToLower(column.name);
  std::string_view lower = lower_case;
  if (lower.size() > 1 && lower.front() == '"' && lower.back() == '"') lower = lower.substr(1, lower.size() - 2);
  std::string_view unit;
  const std::string_view bare = StripUnit(lower, &unit);
  for (const Synonyms& synonyms : Table()) {
    if (std::find(synonyms.names.begin(), synonyms.names.end(), bare) == synonyms.names.end()) continue;
    column.role = synonyms.role;
    column.value_kind = synonyms.kind;
    break;
  }
  if (IsAngle(column.role) && !unit.empty()) {
    if (unit.starts_with("deg") || unit == "\xc2\xb0") column.angle_unit = AngleUnit::kDegrees;
    if (unit.starts_with("rad")) column.angle_unit = AngleUnit::kRadians;
  }
  if (column.role != ColumnRole::kUnknown) return column;
  if (ClassifyChannel(bare, &column) || ClassifyChannel(lower, &column)) {
    column.role = ColumnRole::kChannel;
  } else if (bare.starts_with("sigma_") && ClassifyChannel(bare.substr(6), &column)) {
    column.role = ColumnRole::kSigma;
  } else if (IsMuellerRatio(bare)) {
    column.role = ColumnRole::kIgnored;
  }
  return column;
}

std::string AllowedColumns() {
  return "theta_i, phi_i, theta_o, phi_o, dphi, azimuth with incidence and receive, wavelength, one of f fr f_r brdf "
         "bsdf "
         "value, or R G B, or X Y Z, or wavelengths as 550nm; sigma, weight";
}

}  // namespace lobefit
