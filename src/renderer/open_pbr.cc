#include "lobefit/renderer/open_pbr.h"

#include <algorithm>
#include <cmath>

#include "lobefit/renderer/metal_base.h"

namespace lobefit {

double DiffuseRoughnessOf(const FittedBrdf& fit) {
  const Model& model = fit.material().model;
  if (model.diffuse != Diffuse::kOrenNayar) return 0;
  return MeanOf(fit.material().parameters[FirstParameter(model, model.lobes.size())].values);
}

OpenPbr OpenPbrOf(const FittedBrdf& fit) {
  OpenPbr parameters;
  parameters.diffuse_roughness = DiffuseRoughnessOf(fit);
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
  for (std::size_t c = 0; c < lobe.fresnel.f82.size(); ++c)
    parameters.specular_color[c] = std::clamp(lobe.fresnel.f82[c], 0.0, 1.0);
  const MetalBase metal =
      MetalBaseOf(lobe.fresnel.f0, diffuse, kDefaultDielectric, ToSpectrum(parameters.specular_color));
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
  if (parameters.specular_color != Color3{1, 1, 1}) lobe.fresnel.f82 = ToSpectrum(parameters.specular_color);
  surface.lobes.push_back(lobe);
  lobe.tint = ToSpectrum(parameters.specular_color);
  lobe.weight = 1 - parameters.metalness;
  lobe.fresnel.kind = SurfaceFresnel::Kind::kDielectric;
  lobe.fresnel.eta = {parameters.ior, parameters.ior, parameters.ior};
  surface.lobes.push_back(lobe);
  surface.diffuse_normal = parameters.normal;
  surface.diffuse_roughness = parameters.diffuse_roughness;
  surface.layering = Surface::Layering::kAlbedo;
  surface.layer_lobe = 1;
  for (std::size_t c = 0; c < 3; ++c) surface.diffuse[c] = (1 - parameters.metalness) * base[c];
  return surface;
}

}  // namespace lobefit
