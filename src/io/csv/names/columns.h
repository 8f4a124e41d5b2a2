// What the columns of a goniometer's CSV mean, by their names.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "lobefit/io/csv/names/words.h"
#include "lobefit/io/text/format.h"
#include "lobefit/io/text/units.h"

namespace lobefit {

// Numbers that a pair of directions is made of. Which sets of them make one: directions.h.
enum class Coordinate : std::uint8_t {
  kThetaI,
  kPhiI,
  kThetaO,
  kPhiO,
  kDeltaPhi,      // phi_o - phi_i: 0 is the light's side, 180 degrees the mirror's
  kAzimuth,       // azimuth of the receiver's plane: 90 degrees where it holds the light at a positive receive angle
  kFromSpecular,  // theta_o - theta_i in the plane of incidence
  kBeta0,         // sin theta_i
  kBeta,          // sin theta_o in the plane of incidence
  kBetaOffset,    // beta - beta0
  kBistatic,      // theta_i + theta_o in the plane of incidence: the angle from the light to the viewer
  kDeviation,     // 180 degrees less that: the angle by which the light is turned
  kPhase,         // angle between the two directions
  kThetaH,
  kPhiH,
  kThetaD,
  kPhiD,
  kWiX,
  kWiY,
  kWiZ,
  kWoX,
  kWoY,
  kWoZ,
  kSampleRotation,  // by which the sample was turned counter-clockwise, both directions clockwise in its frame
  kTheta,           // "theta" alone: the viewer's beside a stated light, or a question
  kPhi,             // "phi" or "azimuth" alone: relative beside two polar angles
};
inline constexpr std::size_t kCoordinates = static_cast<std::size_t>(Coordinate::kPhi) + 1;

// How a number gives a polar angle: itself, as 90 degrees less the angle above the surface, or by its cosine.
enum class AngleForm : std::uint8_t { kPolar, kElevation, kCosine };

enum class ColumnRole {
  kCoordinate,
  kWavelength,  // one row a wavelength
  kValue,       // the one channel
  kOtherValue,  // a second reading of the same thing, or one of which the kind is not known: used where it is chosen
  kChannel,     // one of several: R G B, X Y Z, or a wavelength
  kSigma,       // standard deviation of all channels, or of the one that `channel` names
  kWeight,
  kPolarisation,
  kFixed,    // values at the coordinate that the name gives: "AOI=10"
  kNumber,   // the name is a number that is no wavelength: a table whose head holds an angle
  kIgnored,  // known and not needed
  kUnknown
};

struct CsvColumn {
  std::string name;
  ColumnRole role = ColumnRole::kUnknown;
  Coordinate coordinate = Coordinate::kThetaI;  // kCoordinate and kFixed
  double fixed = 0;                             // kFixed, kNumber: the number of the name
  std::optional<double> fixed_incidence;        // kFixed of "45as15": 45, in degrees, beside the aspecular angle
  std::string unit;                             // as written in the name or in a row of units
  bool foreign = false;                         // the name is of another language than English
  std::optional<AngleUnit> angle_unit;          // stated by the name
  AngleForm form = AngleForm::kPolar;
  bool reversed = false;                  // theta_i - theta_o instead of theta_o - theta_i
  bool aspecular = false;                 // reversed by a convention that not all keep to
  bool magnitude = false;                 // |beta - beta0|
  bool of_viewer = false;                 // kPolarisation: behind the sample, before the detector
  bool letter_s = false;                  // "theta_s": scattered, or of the sun where theta_v stands beside it
  std::optional<ValueKind> value_kind;    // implied by the name
  std::optional<ValueScale> value_scale;  // stated by the name
  std::optional<WavelengthUnit> wavelength_unit;
  std::string channel;  // "R", "550nm"
  double wavelength_nm = 0;
  // Of kSigma: relative to the value; standard deviations in the number (2 of an expanded uncertainty with k = 2); a
  // variance.
  bool relative = false;
  double coverage_factor = 1;
  bool variance = false;
  // Why the name cannot be understood, for messages: "the unit 'furlong' is not known".
  std::string problem;
};

// Case, alphabet, separators and order of the words do not matter, nor a unit at the end ("_deg", "(rad)", "[sr^-1]").
CsvColumn ClassifyColumn(std::string_view name);

// Takes the unit of a row below the names for a column whose name has none.
void SetUnit(std::string_view unit, CsvColumn* column);

// True for a name that speaks of an angle without being understood: to ignore it would misread the file.
bool LooksLikeAngle(const CsvColumn& column);

// The name between quotes, for messages.
std::string QuotedName(const CsvColumn& column);

// Names that users can choose from, for messages.
std::string AllowedColumns();

}  // namespace lobefit
