// The search for the best minimum: many cheap descents on small subsamples, few on all samples.
#pragma once

#include <vector>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/distinct.h"
#include "lobefit/fit/search/fit_options.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Distinct minima, the best first; it alone is sure to be descended on all samples. Empty where no start has a finite
// cost. `problem` holds all of `samples`.
std::vector<DistinctMinimum> FindMinima(const Problem& problem, const Layout& layout, const Samples& samples,
                                        const FitOptions& options, ThreadPool* pool);

// Where uncertainties are stated: weighs by the values of the best minimum and descends again, until that gains
// nothing, then from the other minima on all samples. Changes nothing else.
void DescendReweighted(const Layout& layout, ThreadPool* pool, Problem* problem, std::vector<DistinctMinimum>* minima);

}  // namespace lobefit
