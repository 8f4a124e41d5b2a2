// The knots of a profile: none beyond what was measured, where a coefficient would act through the normalisation and
// the masking alone.
#pragma once

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/search/fit_options.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// math.md 8.1: 0, 1 and doublings up to the largest <= r_max, the largest distance from the mean slope that a half
// vector reaches, in alphas; where r_max < 8 also .25 .5 .75 1.5, since a wide lobe lies within its core.
std::vector<double> ProfileKnots(double r_max);

// The recipe with knots for every profile lobe that names none, and starts at the GGX lobes that fit the samples best:
// these give r_max. Other recipes come back as they are.
Recipe WithKnots(const Recipe& recipe, const Samples& samples, const std::vector<std::string>& channels,
                 const FitOptions& options, ThreadPool* pool);

}  // namespace lobefit
