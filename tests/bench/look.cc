#include "tests/bench/look.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/base/process/parallel.h"

namespace lobefit {
namespace {

constexpr int kLightSize = 160, kSkySamples = 255;

// CIE L*a*b* of linear sRGB, D65.
std::array<double, 3> Lab(const std::array<double, 3>& rgb) {
  const std::array<double, 3> xyz = {
      (0.4124 * rgb[0] + 0.3576 * rgb[1] + 0.1805 * rgb[2]) / 0.9505,
      0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2],
      (0.0193 * rgb[0] + 0.1192 * rgb[1] + 0.9505 * rgb[2]) / 1.089,
  };
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  return {116 * f(xyz[1]) - 16, 500 * (f(xyz[0]) - f(xyz[1])), 200 * (f(xyz[1]) - f(xyz[2]))};
}

}  // namespace

std::pair<double, double> CompareSpheres(const LitSphere& table, const LitSphere& fit) {
  const double exposure = SphereExposure(table);
  double square = 0, difference = 0;
  std::size_t pixels = 0;
  for (std::size_t i = 0; i < table.color.size(); ++i) {
    const double x = (static_cast<double>(i % static_cast<std::size_t>(table.size)) + 0.5) / table.size * 2 - 1,
                 y = 1 - (static_cast<double>(i / static_cast<std::size_t>(table.size)) + 0.5) / table.size * 2;
    if (std::hypot(x, y) > 0.966) continue;
    const bool lit = table.color[i][0] + table.color[i][1] + table.color[i][2] > 0;
    if (!lit || table.known[i] == 0) continue;
    std::array<double, 3> a, b;
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = std::clamp(table.color[i][k] * exposure, 0.0, 1.0);
      b[k] = std::clamp(fit.color[i][k] * exposure, 0.0, 1.0);
      square += (a[k] - b[k]) * (a[k] - b[k]) / 3;
    }
    const std::array<double, 3> p = Lab(a), q = Lab(b);
    difference += std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
    ++pixels;
  }
  const auto n = static_cast<double>(pixels);
  return {10 * std::log10(n / std::max(square, 1e-12)), difference / n};
}

Look Render(const ShownBrdf& brdf, const SlopeCoordinates& lobe, const ChannelColor& to_color) {
  return {LightSphere(brdf, to_color, 3, LitRows(kLightSize)),
          SkySphere(brdf, lobe, to_color, 3, kSkySamples, HardwareThreads())};
}

}  // namespace lobefit
