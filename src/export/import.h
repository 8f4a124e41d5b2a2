// Reading material files as renderers evaluate them: our own exports, and hand-made ones of the same form.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/export/targets/imported_material.h"

namespace lobefit {

// The format is recognised by content: a material of pbrt-v4 (.pbrt), Mitsuba 3 (.xml), MaterialX (.mtlx), glTF 2.0
// (.gltf), an RGL table (.bsdf), a MERL table (.binary), or a material document of this program (.json). Throws
// InputError that says what is not understood, and where.
ImportedMaterial ImportMaterial(const std::filesystem::path& path);

}  // namespace lobefit
