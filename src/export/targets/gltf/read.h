// Reading materials of glTF 2.0 (.gltf).
#pragma once

#include <string_view>

#include "lobefit/export/targets/target.h"

namespace lobefit {

bool IsGltf(std::string_view bytes);
// The first material of the file, constant metallic-roughness with the extensions of anisotropy, ior and specular and a
// constant normal map. Throws InputError for a member or an extension that is not understood.
ImportedMaterial ReadGltf(const InputFile& file);

}  // namespace lobefit
