// One measurement from several files: a goniometer's series of one file an incidence, wavelength or sample rotation.
#pragma once

#include <vector>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Parts with the same channels are put one after the other; a pair of directions that several parts have is repeated,
// and is merged to its mean with `merge_repeated`, else its first sample stays and the others are counted. Parts with
// one wavelength each, all different, become channels of the pairs of directions that they share (those that lack one
// are NaN there, see DropIncomplete). Weights of parts that state none count as the mean of the others, their
// standard deviations as the median. Each sample keeps
// its part's number (Samples::file), but where parts are channels. The digest is
// that of the parts' digests, one after the other. Conventions that differ are said to be each file's own.
//
// Throws InputError that names two files where they do not go together: channels, tables with cells beside lists of
// samples, isotropic by construction or not. Domain: one part at least.
Measurement Pool(std::vector<Measurement> parts, bool merge_repeated);

}  // namespace lobefit
