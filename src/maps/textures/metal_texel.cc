#include "lobefit/maps/textures/metal_texel.h"

#include <algorithm>
#include <cmath>

#include "lobefit/renderer/metal_base.h"

namespace lobefit {
namespace {

constexpr double kAsNear = 0.01;

}  // namespace

BaseNumbers BaseNumbersOf(const TexelNumbers& texel, double dielectric) {
  const double largest = *std::max_element(texel.f0.begin(), texel.f0.end());
  if (largest > kMostDielectric) {
    const MetalBase metal = MetalBaseOf(ToSpectrum(texel.f0), ToSpectrum(texel.diffuse), dielectric);
    double off = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double share = 1 - metal.metalness;
      off = std::max({off, std::fabs(metal.metalness * metal.base[c] + share * dielectric - texel.f0[c]),
                      std::fabs(share * metal.base[c] * (1 - dielectric) - texel.diffuse[c])});
    }
    if (off <= kAsNear) return {metal.metalness, metal.base, {dielectric, dielectric, dielectric}};
  }
  BaseNumbers numbers;
  numbers.f0 = texel.f0;
  // The layer dims what is below.
  for (std::size_t c = 0; c < 3; ++c) {
    numbers.base[c] = std::min(1.0, texel.diffuse[c] / std::max(1e-3, 1 - largest));
  }
  return numbers;
}

}  // namespace lobefit
