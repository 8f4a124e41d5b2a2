// The instrument of a fit: what recipe and file say of it together, what is refused, and what its rules need to know of
// a solution.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/search.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// The recipe with the half angles and the mean that the measurement's file states, where the recipe says nothing of
// them. Throws InputError where a disc is so much wider than the step between neighbouring directions that the file
// can hardly mean it: more than kMostSteps of them.
inline constexpr double kMostSteps = 5;
Recipe ThroughInstrument(const Recipe& recipe, const Measurement& measurement);

// Distance from a direction to the nearest other one of the same incidence, median over up to 500 of them; nothing
// where every incidence has one direction only, or for isotropic tables, whose samples do not come by incidence.
std::optional<double> DetectorStep(const Measurement& measurement, const Incidences& incidences);

// With two discs the rule of a mean depends on how narrow the lobes are. Where they became narrower than `layout` was
// made for, makes it anew for their width and descends again from the minima. At most three times.
void RefineRules(const Problem& problem, const std::vector<std::string>& channels, Layout* layout,
                 std::vector<DistinctMinimum>* minima, ThreadPool* pool);

}  // namespace lobefit
