// The last step of a table of lobes that bounds a measurement.
#pragma once

#include "lobefit/base/process/parallel.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Raises amplitudes and constants until no sample lies above the table as it is evaluated. Slices interpolated between
// neighbours, and samples a little off the mean direction of their group, can leave some above. Domain: material->sel
// is set.
void RaiseAboveSamples(const Measurement& measurement, ThreadPool* pool, Material* material);

}  // namespace lobefit
