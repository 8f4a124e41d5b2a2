#include "lobefit/recipe/free_scale.h"

namespace lobefit {

Recipe WithFreeScale(const Recipe& recipe) {
  if (recipe.sel) return recipe;  // lobes of a table have no bounds of reflectance
  Recipe free = recipe;
  for (Lobe& lobe : free.model.lobes) {
    lobe.fresnel = Fresnel::kNone;
    lobe.metal.clear();
  }
  // What the recipe says of parameters that are still there.
  const std::vector<Parameter> before = Parameters(recipe.model), after = Parameters(free.model);
  free.parameters.assign(after.size(), {});
  for (std::size_t i = 0; i < after.size(); ++i) {
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (before[k].name == after[i].name && k < recipe.parameters.size()) free.parameters[i] = recipe.parameters[k];
    }
    if (after[i].group == ParameterGroup::kShape) continue;
    free.parameters[i].fixed.clear();
    free.parameters[i].low = 0;
    free.parameters[i].high = 1e12;
  }
  free.name = recipe.name + "-free-scale";
  return free;
}

}  // namespace lobefit
