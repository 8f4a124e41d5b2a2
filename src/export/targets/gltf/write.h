// glTF 2.0: metallic-roughness with KHR_materials_anisotropy, KHR_materials_ior and KHR_materials_specular.
#pragma once

#include "lobefit/export/targets/target.h"

namespace lobefit {

// One file, with a small curved swatch that has tangents, so that any viewer shows the material.
Target GltfTarget();

}  // namespace lobefit
