// The automatic choice of a recipe for a measurement as it is, few samples included.
#pragma once

#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// AutomaticRecipe of the measurement's traits or, where its usable samples are fewer than that one's free parameters,
// the richest simpler one that they are enough for: one round lobe with a diffuse part, then without. Throws InputError
// that says how many samples are missing where even that is too much.
Recipe ChooseAutomatically(const Measurement& measurement);

}  // namespace lobefit
