// What isotropy says beyond the samples of a file, and what samples say of isotropy.
#pragma once

#include <cstddef>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Isotropic tables store each value at one azimuth (MERL: the half vector in the xz plane), though it holds at all.
// The samples with each pair of directions turned about the normal by its own angle, multiples of the golden angle, so
// that a model that is not isotropic by construction sees every azimuth.
Samples SpreadOverAzimuths(const Samples& samples);

// All light (but that from the normal) at one azimuth: nothing speaks against an isotropic surface.
bool HasOneAzimuth(const Samples& samples);

// Samples of light at one azimuth that reciprocity and isotropy would make equal, and that an anisotropic surface sees
// with half vectors at other azimuths, whichever way its grain runs.
struct IsotropicPairs {
  std::size_t pairs = 0, bright = 0;     // bright: in the larger half of the values
  double median = 0, percentile_90 = 0;  // of the relative differences
  double bright_median = 0;

  // Enough of them agree, the bright ones too: within what good instruments scatter by. Widths of 0.25 and 0.22, seen
  // every 10 degrees, differ by 8 % in the median.
  bool ShowIsotropy() const;
};
IsotropicPairs CompareIsotropicPairs(const Measurement& measurement);

}  // namespace lobefit
