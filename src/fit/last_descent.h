// The last descent of a fit, with what an instrument does besides averaging: gains of the incidences, a crooked sample,
// an offset, half angles, a rectangular detector. The search before it does without them, which leaves its minima near
// where they are and costs a fraction.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/gains.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/search.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// The recipe of the search.
Recipe WithoutLastDescent(const Recipe& recipe);

// What it leaves behind.
struct LastDescent {
  std::unique_ptr<Gains> gains;  // null without drift; `problem` refers to it
  double drift = 0;              // standard deviation of the logarithm of a gain, given or estimated
};

// Goes on from the minima that were refined on all samples, in the coordinates of `recipe`; `layout` and `minima` are
// replaced. With drift to be estimated: the standard deviation of the gains by restricted maximum likelihood
// [Patterson and Thompson 1971] in at most 8 steps of expectation and maximisation [Laird and Ware 1982],
//   s^2 <- mean of (ln g)^2 + sigma^2 (1 / d + h^T H^-1 h / d^2),
// the second part the posterior variance of a gain (GainLink). Does nothing where the recipe has none of these.
LastDescent DescendLast(const Recipe& recipe, const std::vector<std::string>& channels, const Incidences& incidences,
                        Layout* layout, Problem* problem, std::vector<DistinctMinimum>* minima, ThreadPool* pool);

}  // namespace lobefit
