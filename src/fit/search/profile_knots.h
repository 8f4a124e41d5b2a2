// The knots of a profile: none beyond what was measured, where a coefficient would act through the normalisation and
// the masking alone.
#pragma once

#include <memory>
#include <vector>

#include "lobefit/base/process/parallel.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/fit/search/fit_options.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// math.md 8.1: 0, 1 and doublings up to the largest <= r_max, the largest distance from the mean slope that a half
// vector reaches, in alphas; where r_max < 8 also .25 .5 .75 1.5, since a wide lobe lies within its core.
std::vector<double> ProfileKnots(double r_max);

// The largest distance of a sample's half vector from the mean slope of a lobe of this shape, in its metric: in alphas.
double LargestRadius(const Lobe& lobe, const SlopeCoordinates& shape, const Samples& samples);

// The recipe with the knots of `grids` for its profile lobes ([lobe]; null: as they are). What it says of parameters is
// kept by name.
Recipe WithGrids(const Recipe& recipe, const std::vector<std::shared_ptr<const ProfileGrid>>& grids);

// The recipe with knots for every profile lobe that names none, and starts at the GGX lobes that fit the samples best:
// these give r_max. Other recipes come back as they are.
Recipe WithKnots(const Recipe& recipe, const Samples& samples, const std::vector<std::string>& channels,
                 const FitOptions& options, ThreadPool* pool);

}  // namespace lobefit
