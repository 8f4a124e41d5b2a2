// Conservative lobes: an upper bound of the samples of one incident direction with the least integral.
#pragma once

#include "lobefit/fit/sel/slice.h"

namespace lobefit {

// Integral of g over directions: lobes over the whole sphere (SelIntegral), the constant over the hemisphere; summed
// over channels.
double SelSliceIntegral(const SelSlice& slice);

// The slice with the least integral among those of these shapes that lie on or above every sample: amplitudes and
// constants from a linear programme a channel, solved exactly by the simplex method on its dual. As far as rounding
// allows: a sample may lie above by 1e-9 of the largest.
SelSlice LeastBound(const SelSamples& samples, SelQuantity quantity, const SelSlice& shapes);

// The same with the shapes searched for too: a compass search from `start` on their coordinates, with LeastBound at
// every step. `start` should be a fit of the samples. A local minimum.
SelSlice BoundSelSlice(const SelSamples& samples, SelQuantity quantity, const SelSlice& start);

}  // namespace lobefit
