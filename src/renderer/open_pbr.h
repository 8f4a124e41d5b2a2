// The OpenPBR surface, as MaterialX' GLSL evaluates it.
#pragma once

#include "lobefit/renderer/surface.h"

namespace lobefit {

// What an OpenPBR surface holds of a fit: one lobe, a base colour for metal and diffuse base alike.
struct OpenPbr {
  Color3 base_color = {0.8, 0.8, 0.8};
  double base_weight = 1;
  Color3 specular_color = {1, 1, 1};  // of the metal at 82 degrees, of the dielectric's reflection
  double metalness = 0, ior = 1.5;
  double diffuse_roughness = 0;
  RoughnessPair roughness = {0.3, 0};
  double rotation = 0;
  Vec3 normal = {0, 0, 1};
};
// The roughness of the diffuse part, the same in all channels; 0 where it has none.
double DiffuseRoughnessOf(const FittedBrdf& fit);
OpenPbr OpenPbrOf(const FittedBrdf& fit);
Surface OpenPbrSurface(const OpenPbr& parameters);

}  // namespace lobefit
