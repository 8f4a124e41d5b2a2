// One colour for a metal and for the diffuse base of a dielectric, as OpenPBR and glTF have it.
#pragma once

#include "lobefit/renderer/surface.h"

namespace lobefit {

// Reflectances up to here (ior 2.33, beyond which viewers clamp KHR_materials_ior) are a dielectric's over a coloured
// base, beyond a metal's.
inline constexpr double kMostDielectric = 0.16;
inline constexpr double kDefaultDielectric = 0.04;  // ior 1.5

// Metalness and base colour with which a metal of that colour and a dielectric of reflectance `dielectric` over a
// diffuse base of the same colour have the reflectance f0 and the diffuse albedo, in the mean of the channels. Three
// channels.
struct MetalBase {
  double metalness = 1;
  Color3 base = {0, 0, 0};
};
// `tint`: of the dielectric's reflectance.
MetalBase MetalBaseOf(const Spectrum& f0, const Spectrum& diffuse, double dielectric, const Spectrum& tint = {1, 1, 1});

double MeanOf(const Spectrum& color);

}  // namespace lobefit
