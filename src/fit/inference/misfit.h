// Whether the residuals of a fit are structured: means of bins that the noise does not explain say that the model is
// not the one that made the data, whatever the standard errors say.
#pragma once

#include <string>
#include <vector>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Samples are sorted into bins: by the distance of their half vector from the first lobe's centre in its slope space
// (in widths of the lobe), by its azimuth there, by theta_d, by theta_i. Under the right model the mean residual of a
// bin is zero but for noise. Each mean is held against its standard error over the incident directions, so that a drift
// from incidence to incidence is not taken for structure. Fewer than 6 incidences have no standard error to speak of:
// then each has a gain of its own, and what is left within incidences is held against the scatter of the samples. The
// probability is that of the largest of these t statistics [Bonferroni], and the flag is raised below 1 %.
//
// Of large measurements an even part is looked at. Not tested: fewer than 50 samples; residuals that are rounding.
Misfit TestMisfit(const Problem& problem, const Layout& layout, const std::vector<double>& u, const Samples& samples,
                  const Incidences& incidences);

// The remark that people read where the flag is raised.
std::string ToRemark(const Misfit& misfit);

}  // namespace lobefit
