// MaterialX 1.39: generalized_schlick_bsdf or conductor_bsdf plus a diffuse BSDF.
#pragma once

#include "lobefit/export/targets/target.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {

inline constexpr const char* kMaterialXMasking =
    "height-correlated Smith of the mean width, with energy compensation, which MaterialX' own shaders take from a fit "
    "of the albedo, some percent off at grazing";

Target MaterialXTarget();

// Evaluated as MaterialX' own GLSL does, height-correlated masking of the mean width and energy compensation, but by
// the lobe's albedo itself where that has a fit of it.
Surface MaterialXSurface(const FittedBrdf& fit);

}  // namespace lobefit
