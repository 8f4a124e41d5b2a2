#include "lobefit/maps/textures/mixture.h"

#include <algorithm>
#include <cmath>

#include "lobefit/export/targets/features.h"
#include "lobefit/maps/textures/map_target.h"

namespace lobefit {
namespace {

constexpr double kMostReflectance = 0.9999;

double Largest(const Color3& color) { return *std::max_element(color.begin(), color.end()); }

double ShareOf(const TexelNumbers& texel) {
  if (!texel.lobe) return 1;
  const double diffuse = Largest(texel.diffuse), f0 = Largest(texel.f0);
  return std::clamp(diffuse + f0 > 1 ? diffuse / (diffuse + f0) : diffuse, 0.0, 0.999);
}

Color3 DiffuseColor(const TexelNumbers& texel) {
  const double share = ShareOf(texel);
  Color3 color = texel.diffuse;
  for (double& value : color) value = share > 0 ? value / share : 0;
  return color;
}

// Standard deviations of slope along u and v of the ellipse of slopes.
Widths MeshWidths(const TexelNumbers& texel) {
  const double c = std::cos(texel.rotation), s = std::sin(texel.rotation);
  const double x = texel.widths.alpha_1, y = texel.widths.alpha_2;
  return {std::hypot(c * x, s * y), std::hypot(s * x, c * y)};
}

}  // namespace

Color3 ConductorColor(const TexelNumbers& texel) {
  const double share = 1 - ShareOf(texel);
  Color3 color = texel.f0;
  for (double& value : color) value = share > 0 ? std::min(kMostReflectance, value / share) : 0;
  return color;
}

std::vector<Texture> MixtureTextures(const MapNumbers& maps) {
  std::vector<Texture> textures = {ColorTexture("_mix_diffuse.png", DiffuseColor), NormalTexture(false)};
  if (!HasLobes(maps)) return textures;
  textures.push_back(GreyTexture("_mix_share.png", ShareOf));
  textures.push_back(ColorTexture("_mix_specular.png", ConductorColor));
  const auto u = [](const TexelNumbers& texel) { return MeshWidths(texel).alpha_1; };
  if (!IsAnisotropic(maps)) {
    textures.push_back(GreyTexture("_alpha.png", u));
    return textures;
  }
  textures.push_back(GreyTexture("_mix_alpha_u.png", u));
  textures.push_back(
      GreyTexture("_mix_alpha_v.png", [](const TexelNumbers& texel) { return MeshWidths(texel).alpha_2; }));
  return textures;
}

Surface MixtureSurface(const MapNumbers& maps, const std::vector<TextureValue>& read, SurfaceMasking masking) {
  Surface surface;
  surface.masking = masking;
  surface.diffuse = ColorOf(read[kMixDiffuse]);
  surface.diffuse_normal = NormalOf(read[kMixNormal]);
  if (!HasLobes(maps)) return surface;
  const double share = read[kMixShare][0];
  for (double& value : surface.diffuse) value *= share;
  if (share == 1) return surface;
  SurfaceLobe lobe;
  lobe.weight = 1 - share;
  lobe.normal = surface.diffuse_normal;
  lobe.widths = {read[kMixAlphaU][0], read[IsAnisotropic(maps) ? kMixAlphaV : kMixAlphaU][0]};
  lobe.fresnel.kind = SurfaceFresnel::Kind::kConductor;
  for (std::size_t c = 0; c < 3; ++c) lobe.fresnel.k[c] = ConductorOfReflectance(read[kMixSpecular][c]).k;
  surface.lobes.push_back(lobe);
  return surface;
}

std::vector<Carried> MixtureRows(const MapNumbers& maps) {
  std::vector<Carried> rows = CommonRows(maps);
  Mark(&rows, Feature::kRotation, Carries::kNot,
       "the format has no texture for it: the lobe takes its widths along the mesh's u and v");
  Mark(&rows, Feature::kFresnel, Carries::kApproximately,
       "a conductor of the same F0, less at grazing by the share of the diffuse part");
  return rows;
}

}  // namespace lobefit
