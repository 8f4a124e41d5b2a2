#include "lobefit/maps/synthetic/hills.h"

#include <algorithm>
#include <cmath>

namespace lobefit {
namespace {

struct Wave {
  double x, y, phase, amplitude;  // wave numbers in periods across the picture
};
constexpr Wave kWaves[] = {{2, 1, 0.3, 0.045}, {-1, 3, 1.9, 0.026}, {3, 2, 4.0, 0.014}, {5, -4, 2.2, 0.006}};

}  // namespace

Hills MakeHills(std::size_t size, MapLobe lobe, double steepness) {
  constexpr int kChannels = 3;
  Hills hills;
  Maps& maps = hills.maps;
  maps.lobe = lobe, maps.channels = kChannels;
  maps.planes = PlanesFor({lobe, kChannels});
  maps.rows = {0, size, size, {}};
  maps.rows.values.assign(maps.planes.size(), std::vector<float>(size * size));
  hills.height.resize(size * size);
  std::vector<float> numbers(maps.planes.size());
  for (std::size_t row = 0; row < size; ++row) {
    for (std::size_t column = 0; column < size; ++column) {
      // In [0, 1], x right, y up.
      const double n = static_cast<double>(size);
      const double x = (static_cast<double>(column) + 0.5) / n, y = 1 - (static_cast<double>(row) + 0.5) / n;
      double height = 0, dx = 0, dy = 0;
      for (const Wave& wave : kWaves) {
        const double phase = 2 * kPi * (wave.x * x + wave.y * y) + wave.phase;
        height += wave.amplitude * std::sin(phase);
        dx += wave.amplitude * 2 * kPi * wave.x * std::cos(phase);
        dy += wave.amplitude * 2 * kPi * wave.y * std::cos(phase);
      }
      const std::size_t t = row * size + column;
      hills.height[t] = steepness * height * n;
      TexelFit fit;
      fit.normal = Normalized(Vec3{-steepness * dx, -steepness * dy, 1.0});
      const double a = 0.5 + 0.5 * std::sin(2 * kPi * (x + 0.5 * y)), b = 0.5 + 0.5 * std::sin(2 * kPi * (2 * y - x));
      for (int c = 0; c < kChannels; ++c) {
        fit.diffuse[c] = 0.1 + 0.4 * (c == 0 ? a : c == 1 ? b : 1 - a);
        fit.f0[c] = 0.04 + 0.46 * (c == 0 ? b : c == 1 ? 0.8 * b : 0.6 * b);
      }
      fit.alpha_x = 0.12 + 0.28 * (0.5 + 0.5 * std::cos(2 * kPi * (x - y)));
      fit.alpha_y = lobe == MapLobe::kGgx ? fit.alpha_x : 0.45 * fit.alpha_x;
      fit.angle = 0.45 * kPi * std::sin(2 * kPi * x);
      fit.rms = 0, fit.scale = 1;
      if (16 * column < size) {
        fit.alpha_x = fit.alpha_y = fit.angle = kNan;
        for (double& f0 : fit.f0) f0 = kNan;
        fit.status = kMapNoLobe;
      }
      Fill(fit, {lobe, kChannels}, numbers.data());
      for (std::size_t k = 0; k < numbers.size(); ++k) maps.rows.values[k][t] = numbers[k];
    }
  }
  return hills;
}

bool InCastShadow(const Hills& hills, std::size_t texel, const Vec3& direction) {
  const std::size_t size = hills.maps.rows.width;
  const double flat = std::hypot(direction.x, direction.y);
  if (flat < 1e-9) return false;
  const double most = *std::max_element(hills.height.begin(), hills.height.end());
  const double step_x = 0.5 * direction.x / flat, step_y = -0.5 * direction.y / flat;  // rows run down
  const double climb = 0.5 * direction.z / flat;
  double x = static_cast<double>(texel % size), y = static_cast<double>(texel / size), z = hills.height[texel];
  for (int step = 1;; ++step) {
    x += step_x, y += step_y, z += climb;
    if (z > most || x < 0 || y < 0 || x >= static_cast<double>(size - 1) || y >= static_cast<double>(size - 1))
      return false;
    const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
    const double u = x - static_cast<double>(column), v = y - static_cast<double>(row);
    const double* h = hills.height.data() + row * size + column;
    const double ground = (1 - v) * ((1 - u) * h[0] + u * h[1]) + v * ((1 - u) * h[size] + u * h[size + 1]);
    // The first two steps lie on the texel's own slope.
    if (step > 2 && ground > z + 1e-9) return true;
  }
}

}  // namespace lobefit
