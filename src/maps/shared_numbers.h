// Numbers that texels share: of the whole image, or of a cluster of texels that are alike.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "lobefit/maps/clusters.h"
#include "lobefit/maps/recipe.h"
#include "lobefit/maps/stack/stack.h"

namespace lobefit {

struct FittedLights;

struct SharedNumbers {
  struct Group {
    HeldNumbers held;        // what no texel determined is not held
    MapVector error = {};    // standard errors by unknowns of the whole model, in the units of HeldNumbers
    std::size_t texels = 0;  // that spoke
  };
  Clusters clusters;          // no centers: one group for all texels
  std::vector<Group> groups;  // one a cluster; empty: nothing is shared
};

// The numbers of greatest likelihood, all else of a texel free and its level of noise profiled, over at most 4096
// texels on a grid: Newton's method from the medians of the texels' own numbers. Clusters are those of the same texels'
// own numbers (clusters.h). Errors: sandwich with texels as clusters. Reads the stack once; memory: the values of the
// grid.
SharedNumbers EstimateShared(const Stack& stack, const MapRecipe& recipe, const FittedLights& lights, int threads);

// Every digit of them; nullopt where the file is not there or not whole.
std::optional<SharedNumbers> ReadShared(const std::filesystem::path& file);
void WriteShared(const SharedNumbers& shared, const std::filesystem::path& file);

}  // namespace lobefit
