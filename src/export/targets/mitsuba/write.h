// Mitsuba 3: `roughconductor` with GGX, blended with `diffuse`.
#pragma once

#include "lobefit/export/targets/target.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {

// NAME.mitsuba.xml is a scene file with the BSDF, to be included; NAME.mitsuba.py holds the same as a Python dict.
Target MitsubaTarget();

// The fit as Mitsuba evaluates it: exact Fresnel of the nearest index, separable masking, one tangent for all lobes.
Surface MitsubaSurface(const FittedBrdf& fit);

}  // namespace lobefit
