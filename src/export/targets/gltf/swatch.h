// A small curved piece of mesh with tangents, so that any viewer shows a material of glTF.
#pragma once

#include <nlohmann/json.hpp>

namespace lobefit {

// Adds the mesh "swatch" of material 0 with its accessors, views and buffer.
void AddSwatch(nlohmann::ordered_json* gltf);

}  // namespace lobefit
