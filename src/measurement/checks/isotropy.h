// What isotropy says beyond the samples of a file.
#pragma once

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Isotropic tables store each value at one azimuth (MERL: the half vector in the xz plane), though it holds at all.
// The samples with each pair of directions turned about the normal by its own angle, multiples of the golden angle, so
// that a model that is not isotropic by construction sees every azimuth.
Samples SpreadOverAzimuths(const Samples& samples);

}  // namespace lobefit
