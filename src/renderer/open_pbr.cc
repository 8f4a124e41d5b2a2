#include "lobefit/renderer/open_pbr.h"

#include <algorithm>
#include <cmath>

#include "lobefit/renderer/metal_base.h"

namespace lobefit {

OpenPbr OpenPbrOf(const FittedBrdf& fit) {
  OpenPbr parameters;
  const Spectrum diffuse = DiffuseOf(fit);
  const std::size_t strongest = StrongestLobe(fit);
  const SurfaceLobe lobe = LobeOf(fit, strongest, 1);
  parameters.roughness = OpenPbrRoughness(lobe.widths);
  parameters.rotation = lobe.rotation;
  parameters.normal = lobe.normal;
  const double f0 = MeanOf(lobe.fresnel.f0);
  if (fit.HasDiffuse() && *std::max_element(lobe.fresnel.f0.begin(), lobe.fresnel.f0.end()) <= kMostDielectric) {
    const double root = std::sqrt(std::max(f0, 0.0));
    parameters.ior = (1 + root) / (1 - root);
    for (std::size_t c = 0; c < 3; ++c) parameters.base_color[c] = std::min(1.0, diffuse[c] / (1 - f0));
    return parameters;
  }
  const MetalBase metal = MetalBaseOf(lobe.fresnel.f0, diffuse, kDefaultDielectric);
  parameters.metalness = metal.metalness;
  parameters.base_color = metal.base;
  return parameters;
}

Surface OpenPbrSurface(const OpenPbr& parameters) {
  Surface surface;
  Spectrum base = ToSpectrum(parameters.base_color);
  for (double& value : base) value *= parameters.base_weight;
  surface.masking = SurfaceMasking::kMeanAlpha;
  surface.energy_compensation = true;
  SurfaceLobe lobe;
  lobe.widths = OpenPbrWidths(parameters.roughness);
  lobe.rotation = parameters.rotation;
  lobe.normal = parameters.normal;
  lobe.weight = parameters.metalness;
  lobe.fresnel.f0 = base;
  surface.lobes.push_back(lobe);
  lobe.weight = 1 - parameters.metalness;
  lobe.fresnel.kind = SurfaceFresnel::Kind::kDielectric;
  lobe.fresnel.eta = {parameters.ior, parameters.ior, parameters.ior};
  surface.lobes.push_back(lobe);
  surface.diffuse_normal = parameters.normal;
  surface.layering = Surface::Layering::kAlbedo;
  surface.layer_lobe = 1;
  for (std::size_t c = 0; c < 3; ++c) surface.diffuse[c] = (1 - parameters.metalness) * base[c];
  return surface;
}

}  // namespace lobefit
