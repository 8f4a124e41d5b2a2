#include "lobefit/recipe/free_scale.h"

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

// Light that is scattered more than once makes a diffuse part no multiple of its albedo, which stays at most 1.
bool IsLinear(Diffuse diffuse) { return diffuse != Diffuse::kInterfaced && diffuse != Diffuse::kOrenNayar; }

}  // namespace

void LiftReflectanceBounds(Recipe* recipe) {
  const std::vector<Parameter> parameters = Parameters(recipe->model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!parameters[i].is_reflectance) continue;
    recipe->parameters[i].low = 0;
    recipe->parameters[i].high = kLargestReflectance;
  }
}

Recipe WithFreeScale(const Recipe& recipe) {
  if (recipe.sel) return recipe;  // lobes of a table have no bounds of reflectance
  if (CoatOf(recipe.model) < recipe.model.lobes.size()) {
    throw InputError(
        "recipe '" + recipe.name +
        "': what a coat reflects and lets through follows from its index, which values of an unknown scale "
        "do not tell; leave the free scale out, or give the lobe another Fresnel term");
  }
  Recipe free = recipe;
  if (!IsLinear(free.model.diffuse)) free.model.diffuse = Diffuse::kLambert;
  for (Lobe& lobe : free.model.lobes) {
    // The coefficients of a free curve are factors already.
    if (lobe.fresnel != Fresnel::kCurve) lobe.fresnel = Fresnel::kNone;
    lobe.metal.clear();
  }
  // What the recipe says of parameters that are still there.
  const std::vector<Parameter> before = Parameters(recipe.model), after = Parameters(free.model);
  free.parameters.assign(after.size(), {});
  for (std::size_t i = 0; i < after.size(); ++i) {
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (before[k].name == after[i].name && k < recipe.parameters.size()) free.parameters[i] = recipe.parameters[k];
    }
    if (after[i].is_reflectance) free.parameters[i].fixed.clear();
  }
  LiftReflectanceBounds(&free);
  free.free_scale = true;
  if (!free.name.ends_with("-free-scale")) free.name += "-free-scale";
  return free;
}

}  // namespace lobefit
