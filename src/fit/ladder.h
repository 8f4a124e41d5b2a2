// The model of a measurement, chosen by what it predicts: a ladder from one GGX lobe to richer models, each judged on
// incident directions that it has not seen.
//
// Folds are those of compare.h: readings of one incident direction are not split. A step is taken from the best model
// so far: its shape (anisotropic, tilted), its tail (Student's, a free profile), a second lobe, its Fresnel term (a
// free curve), its diffuse part (below an interface). Chosen is the simplest of all that were tried whose held-out mean
// square exceeds the least one by no more than one standard error of the difference over folds. The work is done on a
// stratified subsample, each model's folds from its descent on the whole of it.
#pragma once

#include "lobefit/base/parallel.h"
#include "lobefit/fit/fit.h"

namespace lobefit {

struct LadderChoice {
  Recipe recipe;                  // with its reason
  std::vector<TriedModel> tried;  // in the order of trial; empty where there were too few incidences to judge by
};

// `simplest`: the recipe that the measurement's traits allow (AutomaticRecipe), which gives metric, weighting and
// limits, and is chosen where nothing can be held out. Sets samples aside that the recipe cannot take, as Fit does.
LadderChoice ClimbLadder(const Recipe& simplest, const FitOptions& options, Measurement* measurement);

// Verdict::advice of a fit that is rough or does not describe the data: a model that did better on what was held out,
// or the part that does not fit.
void AddAdvice(Material* material);

}  // namespace lobefit
