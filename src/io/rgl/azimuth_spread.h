// Whether a file that is isotropic by its format holds a surface that is.
#pragma once

#include "lobefit/io/rgl/brdf.h"

namespace lobefit {

// By how much f_r, summed over the channels, varies with the azimuth of the light under a viewer at the normal: there
// it cannot of an isotropic surface. The sample lay still while the light went round it, so that the rows of the first
// slice tell.
struct AzimuthSpread {
  double ratio = 1;    // of the largest to the smallest of six axes, each the mean of an azimuth and its opposite
  double largest = 0;  // azimuth of the largest axis, radians in [0, pi)
};
// The larger ratio of the lights 10 and 20 degrees off the normal. A ratio is 1 where nothing is reflected.
AzimuthSpread SpreadAtNormal(const RglBrdf& brdf);

// A ratio beyond this is that of an anisotropic sample: of the database's files paper has 1.02, an orange wrap and
// flake paint, whose flakes can be told apart, 1.4, satin, silk and northern aurora 1.6 to 2.4.
inline constexpr double kAnisotropicSpread = 1.5;

}  // namespace lobefit
