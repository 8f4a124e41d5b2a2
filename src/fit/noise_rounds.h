// The search under a metric that the noise of the readings allows.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lobefit/fit/found.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// What is fitted. `readings`: the rows of a goniometer, whose noise can be told; tables with cells are computed from
// such.
struct Fitted {
  const Measurement& measurement;
  const Samples& samples;
  const Incidences& incidences;
  bool readings;
};

// Searches under recipe->metric, and estimates the noise from what is left. Where it biases a metric that nobody asked
// for, or recipe->metric is Metric::kAsinh and its noise is not known, the search goes on under kAsinh with that noise,
// which `recipe` then holds, until the noise no longer changes. The errors hold the bias of the metric that was fitted;
// `remarks` say what was chosen and what is biased. Throws InputError as Found does, and where kAsinh is asked for and
// no noise can be told from the model.
std::unique_ptr<Found> FindUnderNoise(const Fitted& fitted, const FitOptions& options, ThreadPool* pool, Recipe* recipe,
                                      std::vector<std::string>* remarks);

}  // namespace lobefit
