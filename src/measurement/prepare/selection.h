// The part of a measurement that is used: ranges of incident directions and a limit on polar angles.
#pragma once

#include <limits>
#include <string>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// A closed range of angles in radians.
struct AngleRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

struct Selection {
  // Polar angle of wi; a range of one value selects one slice (0.05 degrees are allowed on either side).
  AngleRange theta_i;
  // Azimuth of wi; compared modulo a full turn. A range with one bound ends with the turn: of 0 to 360 degrees, or of
  // -180 to 180 where the bound is negative. Does not apply to wi along the normal, which has no azimuth.
  AngleRange phi_i;
  // Both wi and wo must be at most this far from the normal.
  double theta_max = std::numeric_limits<double>::infinity();
};

// Reads "30:60", "30" (one slice), ":60" or "30:" in degrees. `option` names the option in the error. Throws
// UsageError.
AngleRange ParseAngleRange(const std::string& text, const std::string& option);

// Sets the samples outside `selection` aside, as kOutsideSelection or kBeyondAngleLimit. Throws InputError where none
// is left.
void Apply(const Selection& selection, Measurement* measurement);

}  // namespace lobefit
