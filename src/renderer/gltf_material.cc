#include "lobefit/renderer/gltf_material.h"

#include <algorithm>
#include <cmath>

#include "lobefit/renderer/metal_base.h"

namespace lobefit {

GltfMaterial GltfOf(const FittedBrdf& fit) {
  GltfMaterial material;
  SurfaceLobe lobe = LobeOf(fit, StrongestLobe(fit), 1);
  Spectrum diffuse = DiffuseOf(fit);
  const std::size_t coat = CoatOf(fit.material().model);
  if (coat < fit.lobes().size() && fit.lobes().size() > 1) {
    const Widths& widths = fit.lobes()[coat].widths;
    material.clearcoat = std::min(1.0, fit.Fresnel(coat, 0, 1) / kDefaultDielectric);
    material.clearcoat_roughness = std::sqrt(std::sqrt(widths.alpha_1 * widths.alpha_2));
    DimBelowCoat(fit, coat, &lobe.fresnel, &diffuse);
  }
  const Spectrum f0 = lobe.fresnel.f0;
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
  if (material.clearcoat > 0) {
    // Of the surface's own normal: a normal texture does not tilt it.
    const double alpha = std::max(1e-6, material.clearcoat_roughness * material.clearcoat_roughness);
    SurfaceLobe coat;
    coat.widths = {alpha, alpha};
    coat.weight = material.clearcoat;
    coat.fresnel.f0 = Spectrum(3, kDefaultDielectric);
    coat.fresnel.f90 = Spectrum(3, 1.0);
    surface.lobes.push_back(coat);
    surface.coating = Surface::Coating::kFresnel;
    surface.coat_lobe = 1;
  }
  surface.layering = Surface::Layering::kSchlick;
  surface.diffuse_normal = material.normal;
  return surface;
}

}  // namespace lobefit
