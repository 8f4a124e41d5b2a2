// What a recipe says of one parameter. Internal to the recipe's readers.
#pragma once

#include "lobefit/base/files/toml_file.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// { start, fixed, bounds = [low, high], shared, free }, in the parameter's own units of recipes. Throws InputError with
// file and line for what the parameter cannot take.
ParameterRecipe ReadParameter(const toml::node& node, const Parameter& parameter, const TomlFile& place);

}  // namespace lobefit
