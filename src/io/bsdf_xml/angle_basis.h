// Angle bases of BSDF-XML matrices: the hemisphere cut into rings, each ring into patches that are centred on azimuths.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lobefit/math/vec.h"

namespace lobefit {

struct AngleBasis {
  // Polar angles in degrees; the ring's patches are centred at azimuths 360 k / patches degrees.
  struct Ring {
    double lower_deg, upper_deg;
    std::size_t patches;
  };
  std::string name;
  std::vector<Ring> rings;

  struct Patch {
    Vec3 direction;                // of its centre; the cap around the normal has the normal
    double solid_angle;            // sr
    double projected_solid_angle;  // sr; all patches of a basis over the hemisphere sum to pi
  };
  // All patches, ring by ring from the normal, azimuth growing within a ring.
  std::vector<Patch> Patches() const;
  std::size_t size() const;
};

// "LBNL/Klems Full" (145 patches), "LBNL/Klems Half" (73), "LBNL/Klems Quarter" (41).
const std::vector<AngleBasis>& KlemsBases();

}  // namespace lobefit
