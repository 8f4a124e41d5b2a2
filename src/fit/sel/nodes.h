// The incident directions of a measurement as the nodes of a tree of nearest neighbours, each with its slice of a table
// of lobes (sel_fit.h).
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/base/process/parallel.h"
#include "lobefit/base/process/progress.h"
#include "lobefit/fit/sel/slice.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

struct SelNode {
  Vec3 wi;
  SelSamples samples, fitted;  // all, and those to which lobes are fitted
  SelSliceFit fit;
  double variance = 0;  // of the residuals of the first fit
  std::vector<std::size_t> neighbours;
  std::size_t depth = 0;
};

// One node for each incident direction that has as many values as its lobes have parameters. Throws InputError where
// there is none.
std::vector<SelNode> MakeSelNodes(const Measurement& measurement, const Recipe& recipe);

// Prim's tree of nearest neighbours, from the direction nearest to the normal.
void JoinNeighbours(std::vector<SelNode>* nodes);

// Fits every node again, pulled by its neighbours: nodes at even depth first, then those at odd depth, so that the
// joint objective never grows and the threads do not matter.
void SweepSelNodes(const SelSliceOptions& options, double drift, ThreadPool* pool, Progress* progress,
                   std::vector<SelNode>* nodes);

}  // namespace lobefit
