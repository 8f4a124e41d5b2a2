// The OpenPBR surface, as MaterialX' GLSL evaluates it.
#pragma once

#include "lobefit/renderer/surface.h"

namespace lobefit {

// A clear dielectric over all else. It dims what lies below for the viewer's direction and by `color`, makes its lobe
// rougher and its dielectric's reflection that of the ratio of indices; `darkening`: how much of what it throws back
// down inside counts.
struct OpenPbrCoat {
  double weight = 0, ior = 1.6, darkening = 1;
  Color3 color = {1, 1, 1};
  RoughnessPair roughness = {0, 0};
  double rotation = 0;
  Vec3 normal = {0, 0, 1};
};

// What an OpenPBR surface holds of a fit: one lobe, a base colour for metal and diffuse base alike, a coat.
struct OpenPbr {
  Color3 base_color = {0.8, 0.8, 0.8};
  double base_weight = 1;
  Color3 specular_color = {1, 1, 1};  // of the metal at 82 degrees, of the dielectric's reflection
  double metalness = 0, ior = 1.5;
  double diffuse_roughness = 0;
  RoughnessPair roughness = {0.3, 0};
  double rotation = 0;
  Vec3 normal = {0, 0, 1};
  OpenPbrCoat coat;
};
// The roughness of the diffuse part, the same in all channels; 0 where it has none.
double DiffuseRoughnessOf(const FittedBrdf& fit);
OpenPbr OpenPbrOf(const FittedBrdf& fit);
Surface OpenPbrSurface(const OpenPbr& parameters);

}  // namespace lobefit
