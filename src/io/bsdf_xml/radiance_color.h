// The colours of tensor trees, as Radiance writes and reads them: CIE Y, u', v' of its own primaries, (0.640, 0.330),
// (0.290, 0.600) and (0.150, 0.060), with equal energy (1/3, 1/3) for white, so that a neutral reflectance has
// u' = 4/19, v' = 9/19.
#pragma once

#include <array>

namespace lobefit {

// Y, u', v'; black has the chromaticity of white.
std::array<double, 3> RadianceYuv(const std::array<double, 3>& rgb);
// A channel that the chromaticity makes negative is 0, as it is there. Domain: v' > 0.
std::array<double, 3> RadianceRgb(const std::array<double, 3>& yuv);

}  // namespace lobefit
