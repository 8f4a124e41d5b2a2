// What renderers call roughness and anisotropy, and the two GGX widths that they make of it; each map and its inverse.
// alpha_1 >= alpha_2 are the widths along and across the direction in which the highlight is stretched.
#pragma once

namespace lobefit {

struct Widths {
  double alpha_1 = 0, alpha_2 = 0;
};

// Two numbers of a material: a perceptual roughness, and an anisotropy in [0, 1].
struct RoughnessPair {
  double roughness = 0, anisotropy = 0;
};

// pbrt-v4 with remaproughness (its default): alpha = sqrt(roughness).
double PbrtRemappedAlpha(double roughness);
double PbrtRemappedRoughness(double alpha);

// Disney principled, Mitsuba's too: A = sqrt(1 - 0.9 a), alpha = r^2 / A and r^2 A, each at least 0.001. The inverse
// holds up to a ratio of 10; beyond, a = 1.
Widths PrincipledWidths(const RoughnessPair& pair);
RoughnessPair PrincipledRoughness(const Widths& widths);

// MaterialX roughness_anisotropy (standard_surface): A = sqrt(1 - min(a, 0.98)), alpha_1 = min(r^2 / A, 1), alpha_2 =
// r^2 A. The inverse holds up to a ratio of 50.
Widths MaterialXWidths(const RoughnessPair& pair);
RoughnessPair MaterialXRoughness(const Widths& widths);

// OpenPBR: alpha_1 = r^2 sqrt(2 / (1 + (1 - a)^2)), alpha_2 = (1 - a) alpha_1.
Widths OpenPbrWidths(const RoughnessPair& pair);
RoughnessPair OpenPbrRoughness(const Widths& widths);

// glTF 2.0 with KHR_materials_anisotropy: alpha_2 = r^2, alpha_1 = r^2 + (1 - r^2) s^2, s = anisotropyStrength.
// Any alpha_2 <= alpha_1 <= 1 has an exact inverse.
Widths GltfWidths(const RoughnessPair& pair);
RoughnessPair GltfRoughness(const Widths& widths);

}  // namespace lobefit
