// The last descent of a recipe with energy = "conserving".
#pragma once

#include <memory>

#include "lobefit/fit/objective/energy_rule.h"
#include "lobefit/fit/search/search.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {

// Descends from the best minimum with a penalty on albedos above 0.998 at the measured incident directions
// (SpreadIncidences), whose weight grows tenfold until DirectionalAlbedo is at most 1 at all of them, and leaves that
// minimum alone, with the cost of the samples. Does nothing where it is so already. The rule that it returns belongs to
// the problem's cost from then on, and must live as long; its solution is marked as not converged where no weight
// suffices. Throws InputError for recipes that describe an instrument's drift, alignment or offset, and for ABg lobes.
std::unique_ptr<EnergyRule> KeepEnergy(const Recipe& recipe, const Layout& layout, const Incidences& incidences,
                                       const std::vector<std::string>& channels, Problem* problem,
                                       std::vector<DistinctMinimum>* minima, ThreadPool* pool);

}  // namespace lobefit
