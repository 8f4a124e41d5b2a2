// RGL/EPFL tables.
#pragma once

#include "lobefit/export/targets/target.h"

namespace lobefit {

Target RglTarget();

// NAME_rgb.bsdf (Mitsuba's rgb variants) and NAME_spec.bsdf (pbrt-v4, Mitsuba's spectral variants). R G B become a
// smooth spectrum of 11 wavelengths whose R G B are these; of more than 32 wavelengths every k-th is kept.
WrittenFiles WriteRglTarget(const FittedBrdf& fit, const WriteContext& context);

}  // namespace lobefit
