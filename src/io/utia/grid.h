// The grid of directions of UTIA files: 6 polar angles at 15 degrees x 48 azimuths at 7.5 degrees, for light and
// viewer.
#pragma once

#include <cstddef>

#include "lobefit/io/text/format.h"
#include "lobefit/math/directions.h"

namespace lobefit {

// Polar angles in steps of 15 degrees from the normal, each with azimuths all around; the azimuth runs faster.
struct UtiaGrid {
  std::size_t thetas, azimuths;

  constexpr std::size_t directions() const { return thetas * azimuths; }
  Vec3 Direction(std::size_t index) const {
    return FromSpherical(
        DegreesToRadians(15.0 * static_cast<double>(index / azimuths)),
        DegreesToRadians(360.0 / static_cast<double>(azimuths) * static_cast<double>(index % azimuths)));
  }
};

inline constexpr UtiaGrid kUtiaGrid = {6, 48};
inline constexpr std::size_t kUtiaDirections = kUtiaGrid.directions();

// ReadUtia for a table over another grid; small ones are for tests and fuzzing.
Measurement ReadUtiaGrid(const InputFile& file, const ReadOptions& options, const UtiaGrid& grid);

}  // namespace lobefit
