// Repeated measurements of the same pair of directions, merged to their mean with their spread as uncertainty.
#pragma once

#include <cstddef>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

struct Repeats {
  std::size_t pairs = 0;       // pairs of directions with more than one sample
  std::size_t samples = 0;     // their samples
  double relative_spread = 0;  // standard deviation of one sample relative to its pair's mean, pooled over the pairs
};

// Replaces repeated samples (directions equal to 1e-9) by their mean, and states the standard deviation of each mean
// (Samples::sigma). A pair with few repetitions says little about its own spread: the pooled relative spread counts as
// 4 more repetitions of it, and is all there is for a pair that was measured once. Does nothing where no pair is
// repeated. A weight that is there already is averaged.
Repeats MergeRepeated(Measurement* measurement);

}  // namespace lobefit
