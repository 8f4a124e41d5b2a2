// What the columns of a goniometer's CSV mean, by their names.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lobefit/io/text/format.h"

namespace lobefit {

enum class ColumnRole {
  kThetaI,
  kPhiI,
  kThetaO,
  kPhiO,
  kDeltaPhi,    // phi_o - phi_i: 0 is the light's side, 180 degrees the mirror's
  kAzimuth,     // azimuth of the receiver's plane: 90 degrees where it holds the light at a positive receive angle
  kWavelength,  // one row a wavelength
  kValue,       // the one channel
  kOtherValue,  // a second reading of the same thing, used only where it is chosen by name
  kChannel,     // one of several: R G B, X Y Z, or a wavelength
  kSigma,       // standard deviation of all channels, or of the one that `channel` names
  kWeight,
  kIgnored,  // known and not needed
  kUnknown
};

struct CsvColumn {
  std::string name;
  ColumnRole role = ColumnRole::kUnknown;
  std::optional<AngleUnit> angle_unit;  // stated by the name
  std::optional<ValueKind> value_kind;  // implied by the name
  std::string channel;                  // "R", "550nm"
  double wavelength_nm = 0;
};

// Case, a unit at the end ("_deg", "(rad)", "[sr^-1]") and blanks do not matter.
CsvColumn ClassifyColumn(std::string_view name);

// Names that users can choose from, for messages.
std::string AllowedColumns();

}  // namespace lobefit
