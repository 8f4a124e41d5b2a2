// The table [instrument] of a recipe. Internal to the recipe's readers.
#pragma once

#include "lobefit/base/files/toml_file.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// Discs of source and detector, noise, drift, alignment, offset; nothing where `root` has no such table. Throws
// InputError with file and line.
void ReadInstrument(const toml::table& root, const TomlFile& place, Recipe* recipe);

}  // namespace lobefit
