// The material of glTF 2.0 with KHR_materials_anisotropy, _clearcoat, _ior and _specular.
#pragma once

#include "lobefit/renderer/surface.h"

namespace lobefit {

// What a glTF material holds of a fit: one lobe, a base colour for metal and diffuse base alike.
struct GltfMaterial {
  Color3 base_color = {1, 1, 1};
  double metallic = 1;
  RoughnessPair roughness = {1, 0};  // roughnessFactor, anisotropyStrength
  double rotation = 0;               // radians
  double ior = 1.5;
  double specular = 1;
  Color3 specular_color = {1, 1, 1};
  Vec3 normal = {0, 0, 1};                        // the coat's is the surface's own
  double clearcoat = 0, clearcoat_roughness = 0;  // an index of 1.5; the roughness is the root of alpha
};
GltfMaterial GltfOf(const FittedBrdf& fit);
// [glTF 2.0 appendix B and the extensions]: Schlick's term, height-correlated masking of both widths, the diffuse part
// under the largest channel of the dielectric's Fresnel term.
Surface GltfSurface(const GltfMaterial& material);

}  // namespace lobefit
