// A conductor and a diffuse material in a random choice, as pbrt and Mitsuba have it, a texel.
#pragma once

#include "lobefit/export/targets/target.h"
#include "lobefit/maps/textures/texture.h"

namespace lobefit {

// The share of the diffuse part is its largest albedo: a share times a component is the component. Both formats have
// the lobe's axes along the mesh's: widths are those of the slopes along u and v, the rotation is lost.
enum MixturePlace : std::size_t { kMixDiffuse, kMixNormal, kMixShare, kMixSpecular, kMixAlphaU, kMixAlphaV };
// In that order; of maps without a lobe only the first two.
std::vector<Texture> MixtureTextures(const MapNumbers& maps);

// Reflectance at normal incidence of the conductor alone, below 1.
Color3 ConductorColor(const TexelNumbers& texel);

Surface MixtureSurface(const MapNumbers& maps, const std::vector<TextureValue>& read, SurfaceMasking masking);

std::vector<Carried> MixtureRows(const MapNumbers& maps);

}  // namespace lobefit
