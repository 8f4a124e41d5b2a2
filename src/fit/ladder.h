// The model of a measurement, chosen by what it predicts: a ladder from one GGX lobe to richer models, each judged on
// incident directions that it has not seen.
//
// Folds are those of compare.h: readings of one incident direction are not split. The steps: shape (anisotropic,
// tilted); in the simplest shape that predicts as well as the best, its tail (Student's, a free profile) or a second
// lobe; a profile, two lobes, two of Student's and two profiles with a free Fresnel curve; for the best so far a
// diffuse part below an interface, then a lobe about the back direction (both over the one lobe too), then a third
// lobe (without one about the back direction that gains little), then a coat. Chosen is the one with the fewest
// parameters of all that were tried whose held-out mean square exceeds the least one by no more than one standard error
// of the difference over folds; of those, one that reflects no more than it receives before one that does
// (EnergyBalance, for calibrated values). The work is done on a stratified subsample in a few channels, each model's
// folds from its descent on the whole of it.
#pragma once

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/fit.h"

namespace lobefit {

struct LadderChoice {
  Recipe recipe;                  // with its reason
  bool warm = false;              // the recipe's starts are those of the search: few descents find the minimum again
  std::vector<TriedModel> tried;  // in the order of trial; empty where there were too few incidences to judge by
};

// At most so many models are judged (FitOptions::on_tried).
inline constexpr std::size_t kMostTried = 18;
// After so many steps of descents from many starts the best of them are mostly known (FitOptions::scouting_steps).
inline constexpr int kScoutingSteps = 15;
// Descents (FitOptions::starts) of a model whose starts are those of its search.
inline constexpr std::size_t kWarmStarts = 2;

// `simplest`: the recipe that the measurement's traits allow (AutomaticRecipe), which gives metric, weighting and
// limits, and is chosen where nothing can be held out. Sets samples aside that the recipe cannot take, as Fit does.
LadderChoice ClimbLadder(const Recipe& simplest, const FitOptions& options, Measurement* measurement);

// Verdict::advice of a fit that is rough or does not describe the data: a model that did better on what was held out,
// or the part that does not fit.
void AddAdvice(Material* material);

}  // namespace lobefit
