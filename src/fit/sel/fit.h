// Fits a table of squared ellipsoidal lobes to a measurement (recipe with [sel]): for each incident direction one to
// three lobes and a constant.
//
// Each incident direction is fitted on its own from a grid of starts. Then the directions are joined to a tree of
// nearest neighbours, and every one is fitted again from its own and its neighbours' lobes with the neighbours' shapes
// pulling at it: the joint objective is the sum of squares and, over the tree's edges, variance (difference of shapes /
// (drift times angle))^2, with the variance that the first fits left. Directions at even and odd depth of the tree take
// turns, so the objective only falls, and the result does not depend on the number of threads.
#pragma once

#include "lobefit/fit/search/fit_options.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// Domain: recipe.sel is set. Incident directions with fewer values than the lobes have parameters are left to
// interpolation between the others, and a remark says so. With `bound`, the lobes lie on or above all samples, as
// SelReflectance gives them back (by a factor of 1 + 1e-9, which outlasts writing and reading the document). Throws
// InputError where no incident direction has enough samples.
Material FitSel(const Recipe& recipe, const FitOptions& options, Measurement* measurement);

}  // namespace lobefit
