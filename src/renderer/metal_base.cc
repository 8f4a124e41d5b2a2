#include "lobefit/renderer/metal_base.h"

#include <algorithm>
#include <numeric>

namespace lobefit {

double MeanOf(const Spectrum& color) {
  return std::accumulate(color.begin(), color.end(), 0.0) / static_cast<double>(color.size());
}

MetalBase MetalBaseOf(const Spectrum& f0, const Spectrum& diffuse, double dielectric, const Spectrum& tint) {
  MetalBase result;
  // Values of which the scale is free may reflect more than they receive; no base does.
  const double f = std::min(1.0, MeanOf(f0)), rho = MeanOf(diffuse);
  if (rho > 0) {
    // With m = 1 - metalness: m b (1 - dielectric) = rho and (1 - m) b + m dielectric = f, by bisection; the first
    // grows with m from 0.
    const auto base = [&](double m) { return (f - dielectric * m) / (1 - m); };
    double low = 0, high = std::min(0.99, 0.99 * f / dielectric);
    for (int i = 0; i < 60; ++i) {
      const double m = (low + high) / 2;
      (m * base(m) * (1 - dielectric) < rho ? low : high) = m;
    }
    // No base reflects more than all, base(m) <= 1: the diffuse part gives way.
    result.metalness = 1 - std::min(low, (1 - f) / (1 - dielectric));
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const double m = 1 - result.metalness;
    result.base[c] = std::clamp((f0[c] - m * dielectric * tint[c]) / result.metalness, 0.0, 1.0);
  }
  return result;
}

}  // namespace lobefit
