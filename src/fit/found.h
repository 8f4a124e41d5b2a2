// A recipe's search on all samples, and what it found.
#pragma once

#include <memory>
#include <vector>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/errors/uncertainty.h"
#include "lobefit/fit/last_descent.h"
#include "lobefit/fit/objective/energy_rule.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/fit_options.h"
#include "lobefit/fit/search/search.h"

namespace lobefit {

struct Found {
  // Throws InputError where the samples are fewer than what is to be fitted, or no start has a finite cost. `samples`
  // must outlive it.
  Found(const Recipe& recipe, const Measurement& measurement, const Samples& samples, const Incidences& incidences,
        const FitOptions& options, ThreadPool* pool);
  const Solution& best() const { return minima[0].solution; }

  Layout layout;
  Problem problem;
  std::vector<DistinctMinimum> minima;
  LastDescent last;
  std::unique_ptr<EnergyRule> energy;
  Uncertainty uncertainty;
};

}  // namespace lobefit
