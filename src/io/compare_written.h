// What a written file gives back, against what was to be written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/interpolation.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

struct WrittenDifference {
  Difference difference;  // compared is 0 where nothing could be compared; then
  std::string reason;     // says why
};

// Compares `back`, which was read from the written files, with `original` at the same directions and channels.
// A list of samples is compared sample by sample, those that are as far as 0.02 degrees apart in their directions: no
// interpolation, which takes a sample for its exchanged pair, stands between equal numbers. A table is asked at the
// original's samples, by `tabulated` or, where the format defines no function, by interpolation. One channel is
// compared with each of the three that a colour format repeats it in; R G B with X Y Z that were made of it.
WrittenDifference CompareWritten(const Measurement& original, const Measurement& back, bool is_grid,
                                 const BrdfFunction& tabulated);

}  // namespace lobefit
