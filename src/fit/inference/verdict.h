// How well a fitted model describes the data, in one number and one word that a user can act on. Whether the solver
// converged is another matter.
#pragma once

#include "lobefit/base/parallel.h"
#include "lobefit/fit/objective/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/material/material.h"

namespace lobefit {

// Noise: samples that follow each other in the file and belong to one incidence lie next to each other; second
// differences of ln m leave the noise (and what bends within two steps: an upper bound where the grid is coarse), its
// scale by their median. The floor is the same of m among the least quarter of each channel's values.
// Typical error: the median of |ln f / m| over values above three times the floor.
// Verdict: within-noise where that median is no more than 1.2 times what the noise alone gives (0.6745 of its standard
// deviation); else close up to 10 %, below what neighbouring goniometers differ by; rough up to 40 %, where a picture
// is still of that material; does-not-describe beyond, or where the model explains less than a tenth of the squares. At
// most some 200 000 samples are looked at, in runs spread over the file.
Verdict JudgeFit(const Problem& problem, const Layout& layout, const std::vector<double>& u, double explained,
                 ThreadPool* pool);

}  // namespace lobefit
