// How well a fitted model describes the data, in one number and one word that a user can act on. Whether the solver
// converged is another matter.
#pragma once

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {

// Noise: none told where it would be more than 30 % of the value, which is misfit between neighbours. EstimateNoise,
// from neighbouring residuals; at a value v its deviation is hypot(floor / v, relative). Typical error: the median of
// |ln f / m| over values m cos_theta_i above three floors. Verdict: within-noise where that median is no more than 1.2
// times what the noise alone gives (0.6745 of its standard deviation), and where residuals are structured only if that
// noise is no more than 10 %: neighbouring residuals of a model that misses a steep lobe differ by more. Else close up
// to 10 %, below what neighbouring goniometers differ by; rough up to 40 %, where a picture is still of that material;
// does-not-describe beyond, or where the model explains less than a tenth of the squares. At most some 200 000 samples
// are looked at, in runs spread over the file.
Verdict JudgeFit(const Problem& problem, const Layout& layout, const std::vector<double>& u, const Samples& samples,
                 const Incidences& incidences, double explained, bool structured, ThreadPool* pool);

}  // namespace lobefit
