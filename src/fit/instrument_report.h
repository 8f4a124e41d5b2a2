// What a fit found of its instrument, for the document: gains, the alignment and whether it is told from a tilt,
// offsets.
#pragma once

#include <vector>

#include "lobefit/fit/errors/uncertainty.h"
#include "lobefit/fit/last_descent.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {

// Above this correlation with a lobe's tilt, or with an error of more than this share of the prior, an angle of the
// alignment is not told from the tilt.
inline constexpr double kMostTiltCorrelation = 0.9, kMostPriorShare = 0.7;

// Sets material->instrument where the recipe of `layout` has an instrument, and adds remarks. `u`: the solution.
void ReportInstrument(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                      const Uncertainty& uncertainty, const Incidences& incidences, const LastDescent& last,
                      ThreadPool* pool, Material* material);

}  // namespace lobefit
