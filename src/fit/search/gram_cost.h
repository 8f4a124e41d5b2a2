// A bounded objective as Ceres Solver sees it: one residual block of constant size stands for all samples.
#pragma once

#include "lobefit/fit/search/descent.h"

namespace lobefit {

// Descends from a point whose cost, gram and gradient are known, and leaves there those of the point where it ends.
void DescendWithCeres(const BoundedObjective& objective, const DescentOptions& options, Descent* at);

}  // namespace lobefit
