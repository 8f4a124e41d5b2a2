#include "lobefit/fit/found.h"

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/fit/instrument.h"
#include "lobefit/fit/keep_energy.h"

namespace lobefit {

Found::Found(const Recipe& recipe, const Measurement& measurement, const Samples& samples, const Incidences& incidences,
             const FitOptions& options, ThreadPool* pool)
    : layout(WithoutLastDescent(recipe), measurement.channels.names), problem(samples, recipe) {
  if (samples.size() * layout.channels() < layout.size()) {
    throw InputError(
        fmt::format("{}: {} usable samples in {} channels are fewer than the {} free parameters of recipe '{}'; use "
                    "a simpler recipe",
                    measurement.source, samples.size(), layout.channels(), layout.size(), recipe.name));
  }
  minima = FindMinima(problem, layout, samples, options, pool);
  RefineRules(problem, measurement.channels.names, &layout, &minima, pool);
  DescendReweighted(layout, pool, &problem, &minima);
  last = DescendLast(recipe, measurement.channels.names, incidences, &layout, &problem, &minima, pool);
  if (minima.empty()) {
    throw InputError(measurement.source +
                     ": no start of the fit has a finite cost; look at the values with `lobefit info`");
  }
  energy = KeepEnergy(recipe, layout, incidences, measurement.channels.names, &problem, &minima, pool);
  uncertainty = EstimateUncertainty(problem, layout, best().u, incidences, pool);
}

}  // namespace lobefit
