// A fit of other channels as one of R, G, B: what renderers' text formats hold.
#pragma once

#include "lobefit/material/material.h"
#include "lobefit/measurement/spectrum.h"
#include "lobefit/renderer/fitted_brdf.h"

namespace lobefit {

// The map of the fit's channels to R, G, B (MakeChannelMap, "rgb"); of a single wavelength to one grey channel.
// Wavelengths from 480 to 600 nm will do: the spectrum is held constant beyond its ends. Throws UsageError where the
// channels do not determine R, G, B.
ChannelMap RgbMapOf(const FittedBrdf& fit);

// The fit with its channels mapped. Albedos, scales and Schlick's f0 are linear in f_r, so that their map is exact but
// for colours outside the gamut, which are cut at 0; an exact index becomes the one whose curve is nearest to the
// mapped curve. Standard errors are not carried over.
Material RgbFit(const FittedBrdf& fit, const ChannelMap& map);

}  // namespace lobefit
