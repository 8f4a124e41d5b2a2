// pbrt-v4: `conductor` mixed with `diffuse`.
#pragma once

#include "lobefit/export/targets/target.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {

Target PbrtTarget();

// The fit as pbrt evaluates it: exact Fresnel, height-correlated masking, one tangent for all lobes. A lobe of grey or
// hardly coloured reflectance, and one of a spectrum, gets the index whose curve is nearest to the fit's; a saturated
// one of R, G, B keeps eta = 1 and the k of its reflectance (`reflectance`), since pbrt makes spectra of eta and k one
// by one. A width below 1e-3 becomes 1e-3 where the other is below that too: pbrt makes a mirror of such a lobe.
Surface PbrtSurface(const FittedBrdf& fit);

}  // namespace lobefit
