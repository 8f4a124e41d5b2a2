// Very many small fits in one call: pixels of a sample that varies over its surface, trials of a study.
#pragma once

#include <vector>

#include "lobefit/core/brdf/model.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

struct FitManyOptions {
  int threads = 1;
  int max_iterations = 50;
  double function_tolerance = 1e-10;  // relative decrease of the cost at which a descent ends
};

struct SmallFit {
  ParameterValues values;  // inside units, in the order of Parameters(model)
  double cost = 0;         // half the sum of squares, as Material::cost
  bool converged = false;
  int iterations = 0;
};

// Fits a recipe of one lobe to each of `samples` (all with the same channels), without intervals or reports; use Fit
// for those. Starts are 18 round lobes, about the normal and about the peak of the half vectors, judged with their
// amplitudes solved for under the metric made linear about the data; the best one descends by Levenberg-Marquardt on
// the same sums as Fit, so that where both find the same minimum they agree. The samples are taken as they are: set
// aside first what the metric cannot take (SetAsideForRecipe). Throws InputError for recipes of several lobes and for
// Fresnel terms that are not linear in their parameter; a problem with fewer values than parameters, or without a
// finite cost, comes back not converged.
std::vector<SmallFit> FitMany(const Recipe& recipe, const std::vector<const Samples*>& samples,
                              const FitManyOptions& options);

}  // namespace lobefit
