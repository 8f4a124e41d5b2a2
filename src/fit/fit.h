// Fits a recipe to a measurement: starts, descents, the best minimum, its uncertainty, and all that a report says of
// it.
#pragma once

#include <optional>

#include "lobefit/fit/search/fit_options.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// What the automatic recipe needs to know.
MeasurementTraits TraitsOf(const Measurement& measurement);

// Sets samples aside that the recipe cannot take (counted in the measurement and the result), then fits. The result
// does not depend on the number of threads. Throws InputError where there is nothing to fit: no sample left, fewer
// values than free parameters. A fit that did not converge or is not determined is returned, and says so in
// Material::termination.
Material Fit(const Recipe& wanted, const FitOptions& options, Measurement* measurement);

// FitSel (fit/sel/fit.h) for a recipe with [sel], else Fit.
Material FitRecipe(const Recipe& recipe, const FitOptions& options, Measurement* measurement);

// What an automatic choice turns to where its first result shows that it was wrong: an in-plane measurement does not
// see the lobe's width across the plane, which scales the values as f0 does; where f0 ends at 1 they become one free
// scale. Nothing: keep the result.
std::optional<Recipe> AutomaticAlternative(const Recipe& recipe, const Material& material);

}  // namespace lobefit
