// Samples that lack a channel: readers keep them until it is known which channels are used.
#pragma once

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// MeasurementBuilder takes a sample that has a value in one channel at least and leaves NaN in the others. Sets those
// without a value in each channel aside as holes; what is left is as Measurement promises.
void DropIncomplete(Measurement* measurement);

}  // namespace lobefit
