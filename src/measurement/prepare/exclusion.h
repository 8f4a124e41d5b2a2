// Zones that a user excludes: where the instrument sees itself, shades the light, saturates or cannot see.
#pragma once

#include <string>
#include <vector>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

struct Exclusion {
  enum class Zone {
    kSpecular,    // wo within `limit` radians of the mirror direction of wi
    kRetro,       // wo within `limit` radians of wi
    kValueBelow,  // any channel below `limit`, 1/sr
    kValueAbove,
    kThetaIBelow,  // radians
    kThetaIAbove,
    kThetaOBelow,
    kThetaOAbove,
  };
  Zone zone = Zone::kSpecular;
  double limit = 0;
};

// "specular:5deg,retro:3,value<0.001,value>=100,theta-o>80": angles in degrees unless they end in rad. Throws
// UsageError that says what is allowed.
std::vector<Exclusion> ParseExclusions(const std::string& text);

// Sets the samples in the zones aside as outside the selection; a remark counts them by zone. Throws InputError where
// none is left.
void Apply(const std::vector<Exclusion>& exclusions, Measurement* measurement);

}  // namespace lobefit
