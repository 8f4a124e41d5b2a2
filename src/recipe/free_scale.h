// Values of which the scale is not known: counts, arbitrary units, relative to a peak.
#pragma once

#include "lobefit/recipe/recipe.h"

namespace lobefit {

// The recipe without what only calibrated values can hold: each lobe has a free factor in place of its Fresnel term (a
// free curve is kept), a diffuse part whose light is scattered more than once gives way to Lambert's, and no amplitude
// is bounded by 1, so that the shape is fitted and the amplitudes stand relative to each other. Metals' indices are
// dropped with their Fresnel term. Throws InputError for a model with a coat.
Recipe WithFreeScale(const Recipe& recipe);

// Amplitudes and albedos (free, from 0, one a channel) without the bound of 1, but for albedos of which a diffuse part
// is no multiple.
void LiftReflectanceBounds(Recipe* recipe);

}  // namespace lobefit
