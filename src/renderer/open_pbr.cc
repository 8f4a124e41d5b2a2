#include "lobefit/renderer/open_pbr.h"

#include <algorithm>
#include <cmath>

#include "lobefit/renderer/metal_base.h"

namespace lobefit {
namespace {

// [OpenPBR, roughening due to coat]: the fourth powers of the roughnesses add, that of the coat twice.
double Roughened(double roughness, const OpenPbrCoat& coat) {
  const double sum = std::pow(roughness, 4) + 2 * std::pow(coat.roughness.roughness, 4);
  return std::lerp(roughness, std::pow(std::min(1.0, sum), 0.25), coat.weight);
}
// The roughness that a coat of weight 1 makes into this one; 0 where the coat alone makes more.
double BeforeRoughening(double roughness, const OpenPbrCoat& coat) {
  return std::pow(std::max(0.0, std::pow(roughness, 4) - 2 * std::pow(coat.roughness.roughness, 4)), 0.25);
}

// The index that counts for the dielectric's reflection below the coat: the ratio of the two, and at least 1.
double IndexBelow(double ior, const OpenPbrCoat& coat) {
  return std::lerp(ior, std::max(ior / coat.ior, coat.ior / ior), coat.weight);
}

// [OpenPBR, coat darkening], with the internal diffuse reflection K of the coat and the base's colour as its albedo.
double Darkened(double base, const OpenPbrCoat& coat) {
  const double root = (coat.ior - 1) / (coat.ior + 1), inside = 1 - (1 - root * root) / (coat.ior * coat.ior);
  return std::lerp(1.0, (1 - inside) / (1 - base * inside), coat.weight * coat.darkening);
}

// No width is below that of MaterialX' GLSL.
Widths WidthsOf(const RoughnessPair& pair) {
  const Widths widths = OpenPbrWidths(pair);
  return {std::clamp(widths.alpha_1, 1e-6, 1.0), std::clamp(widths.alpha_2, 1e-6, 1.0)};
}

OpenPbrCoat CoatFrom(const FittedBrdf& fit, std::size_t lobe) {
  OpenPbrCoat coat;
  coat.weight = 1;
  coat.darkening = 0;
  coat.ior = fit.material().parameters[FirstFresnel(fit.material().model, lobe)].values[0];
  coat.roughness = OpenPbrRoughness(fit.lobes()[lobe].widths);
  return coat;
}

void PutCoatOver(const OpenPbr& parameters, Surface* surface) {
  const OpenPbrCoat& coat = parameters.coat;
  for (std::size_t c = 0; c < 3; ++c) {
    const double left = Darkened(parameters.base_color[c], coat) * std::lerp(1.0, coat.color[c], coat.weight);
    for (SurfaceLobe& lobe : surface->lobes) {
      if (lobe.tint.empty()) lobe.tint.assign(3, 1.0);
      lobe.tint[c] *= left;
    }
    surface->diffuse[c] *= left;
  }
  SurfaceLobe lobe;
  lobe.widths = WidthsOf(coat.roughness);
  lobe.rotation = coat.rotation;
  lobe.normal = coat.normal;
  lobe.weight = coat.weight;
  lobe.fresnel.kind = SurfaceFresnel::Kind::kDielectric;
  lobe.fresnel.eta = {coat.ior, coat.ior, coat.ior};
  surface->coating = Surface::Coating::kAlbedo;
  surface->coat_lobe = surface->lobes.size();
  surface->lobes.push_back(lobe);
}

}  // namespace

double DiffuseRoughnessOf(const FittedBrdf& fit) {
  const Model& model = fit.material().model;
  if (model.diffuse != Diffuse::kOrenNayar) return 0;
  return MeanOf(fit.material().parameters[FirstParameter(model, model.lobes.size())].values);
}

OpenPbr OpenPbrOf(const FittedBrdf& fit) {
  OpenPbr parameters;
  parameters.diffuse_roughness = DiffuseRoughnessOf(fit);
  Spectrum diffuse = DiffuseOf(fit);
  const std::size_t strongest = StrongestLobe(fit), coat = CoatOf(fit.material().model);
  SurfaceLobe lobe = LobeOf(fit, strongest, 1);
  parameters.roughness = OpenPbrRoughness(lobe.widths);
  double below = 1;  // the index of what lies over the dielectric
  if (coat < fit.lobes().size() && strongest != coat) {
    parameters.coat = CoatFrom(fit, coat);
    parameters.roughness.roughness = BeforeRoughening(parameters.roughness.roughness, parameters.coat);
    below = parameters.coat.ior;
    parameters.ior *= below;
    DimBelowCoat(fit, coat, &lobe.fresnel, &diffuse);
  }
  parameters.rotation = lobe.rotation;
  parameters.normal = lobe.normal;
  const double largest = *std::max_element(lobe.fresnel.f0.begin(), lobe.fresnel.f0.end());
  if (fit.HasDiffuse() && largest <= kMostDielectric) {
    const double root = std::sqrt(std::max(largest, 0.0));
    parameters.ior = below * (1 + root) / (1 - root);
    for (std::size_t c = 0; c < 3; ++c) {
      parameters.specular_color[c] = largest > 0 ? std::clamp(lobe.fresnel.f0[c] / largest, 0.0, 1.0) : 1.0;
      parameters.base_color[c] = std::min(1.0, diffuse[c] / (1 - largest));
    }
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
  lobe.widths = WidthsOf({Roughened(parameters.roughness.roughness, parameters.coat), parameters.roughness.anisotropy});
  lobe.rotation = parameters.rotation;
  lobe.normal = parameters.normal;
  lobe.weight = parameters.metalness;
  lobe.fresnel.f0 = base;
  if (parameters.specular_color != Color3{1, 1, 1}) lobe.fresnel.f82 = ToSpectrum(parameters.specular_color);
  surface.lobes.push_back(lobe);
  lobe.tint = ToSpectrum(parameters.specular_color);
  lobe.weight = 1 - parameters.metalness;
  lobe.fresnel.kind = SurfaceFresnel::Kind::kDielectric;
  lobe.fresnel.eta.assign(3, IndexBelow(parameters.ior, parameters.coat));
  surface.lobes.push_back(lobe);
  surface.diffuse_normal = parameters.normal;
  surface.diffuse_roughness = parameters.diffuse_roughness;
  surface.layering = Surface::Layering::kAlbedo;
  surface.layer_lobe = 1;
  for (std::size_t c = 0; c < 3; ++c) surface.diffuse[c] = (1 - parameters.metalness) * base[c];
  if (parameters.coat.weight > 0) PutCoatOver(parameters, &surface);
  return surface;
}

}  // namespace lobefit
