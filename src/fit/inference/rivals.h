// Second solutions that the measurement cannot tell from the best: no standard error speaks of them.
#pragma once

#include <vector>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/search.h"
#include "lobefit/material/material.h"

namespace lobefit {

// Names the rivals of minima[0] in material->degenerate, and takes the standard errors from the parameters that they
// put elsewhere: further than two standard errors away. Rivals are minima whose cost, found on all samples, is within
// the 95 % quantile of the likelihood ratio with one degree of freedom (widened where samples of an incidence err
// together, and in the unit of a loss), and, for samples in one plane, the mirror image
// of the solution, which has the same cost by symmetry. Returns whether there is one. `material` holds the parameters
// of minima[0] with their standard errors; `samples` are those of `problem`.
bool FlagRivals(const Problem& problem, const Layout& layout, const Samples& samples,
                const std::vector<DistinctMinimum>& minima, ThreadPool* pool, Material* material);

}  // namespace lobefit
