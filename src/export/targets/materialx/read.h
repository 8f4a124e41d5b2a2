// Reading MaterialX documents.
#pragma once

#include <string_view>

#include "lobefit/export/targets/target.h"

namespace lobefit {

bool IsMaterialX(std::string_view bytes);
// The first material of the document: a surface of conductor_bsdf, generalized_schlick_bsdf and
// oren_nayar_diffuse_bsdf, added or mixed, or an open_pbr_surface (format "openpbr"). Inputs that are not evaluated
// must have the value at which they have no effect. Throws InputError.
ImportedMaterial ReadMaterialX(const InputFile& file);

}  // namespace lobefit
