// What to fit to each texel: fits/maps/*.toml.
#pragma once

#include <filesystem>
#include <string>

#include "lobefit/maps/engine/texel.h"

namespace lobefit {

struct MapRecipe {
  std::string name = "ggx-maps";
  MapRules rules;            // its `schlick` follows from the stack
  bool share_alpha = false;  // one width for the whole image
};

// Keys: model = lambert, ggx, ggx-anisotropic; normal = free, fixed; lobe = by-evidence, always; loss, shadow;
// share_alpha = texel, image; least_alpha. Throws InputError with file and line; UsageError for what contradicts itself.
MapRecipe ReadMapRecipe(const std::filesystem::path& file);

// One line with everything that changes a result, for digests and documents.
std::string RecipeText(const MapRecipe& recipe);

}  // namespace lobefit
