// The grid of directions of UTIA files: 6 polar angles at 15 degrees x 48 azimuths at 7.5 degrees, for light and
// viewer.
#pragma once

#include <cstddef>

#include "lobefit/math/directions.h"

namespace lobefit {

inline constexpr std::size_t kUtiaAzimuths = 48;
inline constexpr std::size_t kUtiaDirections = 6 * kUtiaAzimuths;

inline Vec3 UtiaDirection(std::size_t index) {
  return FromSpherical(DegreesToRadians(15.0 * static_cast<double>(index / kUtiaAzimuths)),
                       DegreesToRadians(7.5 * static_cast<double>(index % kUtiaAzimuths)));
}

}  // namespace lobefit
