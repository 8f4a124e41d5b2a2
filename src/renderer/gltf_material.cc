#include "lobefit/renderer/gltf_material.h"

#include <algorithm>
#include <cmath>

#include "lobefit/renderer/metal_base.h"

namespace lobefit {

GltfMaterial GltfOf(const FittedBrdf& fit) {
  GltfMaterial material;
  const SurfaceLobe lobe = LobeOf(fit, StrongestLobe(fit), 1);
  const Spectrum diffuse = DiffuseOf(fit), f0 = lobe.fresnel.f0;
  material.roughness = GltfRoughness(lobe.widths);
  material.rotation = lobe.rotation;
  material.normal = lobe.normal;
  const double largest = *std::max_element(f0.begin(), f0.end());
  if (fit.HasDiffuse() && largest <= kMostDielectric) {
    material.metallic = 0;
    const double root = std::sqrt(std::max(largest, 0.0));
    material.ior = (1 + root) / (1 - root);
    for (std::size_t c = 0; c < 3; ++c) {
      material.specular_color[c] = largest > 0 ? f0[c] / largest : 1.0;
      material.base_color[c] = std::min(1.0, diffuse[c] / (1 - largest));
    }
    return material;
  }
  const MetalBase metal = MetalBaseOf(f0, diffuse, kDefaultDielectric);
  material.metallic = metal.metalness;
  material.base_color = metal.base;
  return material;
}

Surface GltfSurface(const GltfMaterial& material) {
  Surface surface;
  SurfaceLobe lobe;
  lobe.widths = GltfWidths(material.roughness);
  lobe.rotation = material.rotation;
  lobe.normal = material.normal;
  const double root = (material.ior - 1) / (material.ior + 1), dielectric = 1 - material.metallic;
  for (std::size_t c = 0; c < 3; ++c) {
    const double f0 = std::min(1.0, root * root * material.specular_color[c]);
    surface.layer.f0[c] = material.specular * f0;
    surface.layer.f90[c] = material.specular;
    // Both terms are Schlick's, so that their mixture is.
    lobe.fresnel.f0[c] = material.metallic * material.base_color[c] + dielectric * surface.layer.f0[c];
    lobe.fresnel.f90[c] = material.metallic + dielectric * material.specular;
    surface.diffuse[c] = dielectric * material.base_color[c];
  }
  surface.lobes.push_back(lobe);
  surface.layering = Surface::Layering::kSchlick;
  surface.diffuse_normal = material.normal;
  return surface;
}

}  // namespace lobefit
