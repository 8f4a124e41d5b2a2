#include "lobefit/renderer/roughness.h"

#include <algorithm>
#include <cmath>

namespace lobefit {

double PbrtRemappedAlpha(double roughness) { return std::sqrt(roughness); }
double PbrtRemappedRoughness(double alpha) { return alpha * alpha; }

Widths PrincipledWidths(const RoughnessPair& pair) {
  const double r2 = pair.roughness * pair.roughness, aspect = std::sqrt(1 - 0.9 * pair.anisotropy);
  return {std::max(0.001, r2 / aspect), std::max(0.001, r2 * aspect)};
}

RoughnessPair PrincipledRoughness(const Widths& widths) {
  const double ratio = widths.alpha_2 / widths.alpha_1;
  return {std::pow(widths.alpha_1 * widths.alpha_2, 0.25), std::clamp((1 - ratio) / 0.9, 0.0, 1.0)};
}

Widths MaterialXWidths(const RoughnessPair& pair) {
  const double r2 = pair.roughness * pair.roughness, aspect = std::sqrt(1 - std::clamp(pair.anisotropy, 0.0, 0.98));
  return {std::min(r2 / aspect, 1.0), r2 * aspect};
}

RoughnessPair MaterialXRoughness(const Widths& widths) {
  const double ratio = widths.alpha_2 / widths.alpha_1;
  return {std::pow(widths.alpha_1 * widths.alpha_2, 0.25), std::clamp(1 - ratio, 0.0, 0.98)};
}

Widths OpenPbrWidths(const RoughnessPair& pair) {
  const double left = 1 - pair.anisotropy;
  const double alpha_1 = pair.roughness * pair.roughness * std::sqrt(2 / (1 + left * left));
  return {alpha_1, left * alpha_1};
}

RoughnessPair OpenPbrRoughness(const Widths& widths) {
  const double mean_square = (widths.alpha_1 * widths.alpha_1 + widths.alpha_2 * widths.alpha_2) / 2;
  return {std::pow(mean_square, 0.25), 1 - widths.alpha_2 / widths.alpha_1};
}

Widths GltfWidths(const RoughnessPair& pair) {
  const double r2 = pair.roughness * pair.roughness;
  return {r2 + (1 - r2) * pair.anisotropy * pair.anisotropy, r2};
}

RoughnessPair GltfRoughness(const Widths& widths) {
  const double rest = 1 - widths.alpha_2;
  const double share = rest > 0 ? std::max(0.0, (widths.alpha_1 - widths.alpha_2) / rest) : 0.0;
  return {std::sqrt(widths.alpha_2), std::sqrt(share)};
}

}  // namespace lobefit
