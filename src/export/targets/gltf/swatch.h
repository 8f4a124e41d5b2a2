// A small piece of mesh with tangents, so that any viewer shows a material of glTF.
#pragma once

#include <nlohmann/json.hpp>

namespace lobefit {

// `curved`: a cap of a sphere, which shows a lobe from all sides; else flat, for pictures. `aspect`: width over height.
struct SwatchForm {
  bool curved = true;
  double aspect = 1;
};
// Adds the mesh "swatch" of material 0 with its accessors, views and buffer.
void AddSwatch(nlohmann::ordered_json* gltf, const SwatchForm& form = {});

}  // namespace lobefit
