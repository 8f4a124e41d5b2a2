// The input parametrisations of ALTA files as pairs of directions.
#pragma once

#include <string_view>
#include <vector>

#include "lobefit/math/vec.h"

namespace lobefit {

// One input parametrisation ("#PARAM_IN"): its name in files, number of coordinates, whether it can express a
// dependence on the azimuth of the sample, and the conversion. `convert` gives unit directions away from the surface,
// or directions below the horizon for coordinates that no pair above it has. Angles in radians. wi is ALTA's light L,
// wo its view V.
struct AltaInput {
  std::string_view name;
  std::size_t dimension;
  bool isotropic;
  void (*convert)(const double* x, Vec3* wi, Vec3* wo);
};

// All that are known; SCHLICK_VK is there under its other spelling SCHLICK_VH, too.
const std::vector<AltaInput>& AltaInputs();

}  // namespace lobefit
