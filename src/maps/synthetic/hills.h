// A surface that was never measured: hills of smoothly varying reflectance, for samples and tests.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/maps/output/exr.h"

namespace lobefit {

struct Hills {
  Maps maps;                   // calibrated; errors NaN
  std::vector<double> height;  // in texels, [row width + column], whose gradient the normals are
};

// Slopes up to about 40 degrees; diffuse albedo 0.1 to 0.5, f0 0.04 to 0.5, alpha 0.12 to 0.4; a sixteenth of the width
// at the left has no lobe. `steepness` scales the heights. Domain: size >= 8, lobe not kNone.
Hills MakeHills(std::size_t size, MapLobe lobe, double steepness = 1);

// Whether something of the height field stands between the texel and a light in `direction`, by steps of half a texel.
bool InCastShadow(const Hills& hills, std::size_t texel, const Vec3& direction);

}  // namespace lobefit
