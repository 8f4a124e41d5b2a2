#include "lobefit/maps/textures/numbers.h"

#include <algorithm>
#include <cmath>

#include "lobefit/maps/textures/region_median.h"

namespace lobefit {
namespace {

constexpr std::size_t kDiffuse = 3;  // planes: normal.x .y .z, then diffuse (planes.h)

// 99.5th percentile of the largest channel of diffuse + f0.
double WhiteOf(const Maps& maps) {
  std::vector<double> sums;
  const auto channels = static_cast<std::size_t>(maps.channels);
  const bool lobe = maps.lobe != MapLobe::kNone;
  for (std::size_t t = 0; t < maps.rows.rows * maps.rows.width; ++t) {
    double most = kNan;
    for (std::size_t c = 0; c < channels; ++c) {
      const auto diffuse = static_cast<double>(maps.rows.values[kDiffuse + c][t]);
      const double f0 = lobe ? static_cast<double>(maps.rows.values[kDiffuse + channels + c][t]) : 0;
      most = std::fmax(most, diffuse + (std::isnan(f0) ? 0 : f0));
    }
    if (std::isfinite(most)) sums.push_back(most);
  }
  if (sums.empty()) return 1;
  const auto at = sums.begin() + static_cast<std::ptrdiff_t>((sums.size() - 1) * 995 / 1000);
  std::nth_element(sums.begin(), at, sums.end());
  return *at > 0 ? *at : 1;
}

// Azimuth of the tangent in the mesh's plane that, made perpendicular to the normal, is the axis at `angle` in the
// frame of the shortest turn (engine/model.h).
double AzimuthOf(const Vec3& normal, double angle) {
  const MapFrame frame = FrameOf(normal);
  const Vec3 axis = std::cos(angle) * frame.t + std::sin(angle) * frame.b;
  const Vec3 flat = axis - (axis.z / normal.z) * normal;
  return std::atan2(flat.y, flat.x);
}

}  // namespace

Surface SurfaceOf(const TexelNumbers& numbers, bool schlick) {
  Surface surface;
  surface.masking = SurfaceMasking::kSeparable;
  surface.diffuse = ToSpectrum(numbers.diffuse);
  surface.diffuse_normal = numbers.normal;
  if (!numbers.lobe) return surface;
  SurfaceLobe lobe;
  lobe.widths = numbers.widths, lobe.rotation = numbers.rotation, lobe.normal = numbers.normal;
  lobe.fresnel.f0 = ToSpectrum(numbers.f0);
  if (!schlick) lobe.fresnel.f90 = lobe.fresnel.f0;
  surface.lobes.push_back(lobe);
  return surface;
}

MapNumbers::MapNumbers(const Maps& maps, bool calibrated, double white)
    : maps_(maps), calibrated_(calibrated), white_(white) {
  if (std::isnan(white)) white_ = calibrated ? 1 : WhiteOf(maps);
  const auto channels = static_cast<std::size_t>(maps.channels);
  f0_ = kDiffuse + channels, alpha_ = f0_ + channels;
  const std::size_t texels = width() * height();
  const auto parameters = static_cast<std::size_t>(std::count_if(
      maps.planes.begin(), maps.planes.end(), [](const MapPlane& p) { return p.part == MapPart::kParameters; }));
  std::vector<std::size_t> missing(parameters);
  for (std::size_t t = 0; t < texels; ++t) {
    if (!Inside(t)) continue;
    ++inside_;
    for (std::size_t k = 0; k < parameters; ++k) {
      if (std::isnan(maps.rows.values[k][t]) && (k < f0_ || HasLobe(t))) ++missing[k];
    }
  }
  medians_.resize(parameters);
  for (std::size_t k = 0; k < parameters; ++k) {
    if (missing[k] > 0) medians_[k] = RegionMedians(maps.rows.values[k], width(), height());
  }
  filled_.normal = missing[0], filled_.diffuse = missing[kDiffuse];
  if (maps.lobe != MapLobe::kNone) filled_.f0 = missing[f0_], filled_.width = missing[alpha_];
}

bool MapNumbers::Inside(std::size_t texel) const {
  return (static_cast<unsigned>(maps_.rows.values.back()[texel]) & kMapOutside) == 0;
}

bool MapNumbers::HasLobe(std::size_t texel) const {
  return maps_.lobe != MapLobe::kNone && (static_cast<unsigned>(maps_.rows.values.back()[texel]) & kMapNoLobe) == 0;
}

double MapNumbers::Value(std::size_t plane, std::size_t texel) const {
  const float value = maps_.rows.values[plane][texel];
  return static_cast<double>(std::isnan(value) && !medians_[plane].empty() ? medians_[plane][texel] : value);
}

TexelNumbers MapNumbers::At(std::size_t texel) const {
  TexelNumbers numbers;
  if (!Inside(texel)) return numbers;
  const Vec3 normal = {Value(0, texel), Value(1, texel), Value(2, texel)};
  // Nowhere determined: the surface faces the camera.
  if (normal.z > 0) numbers.normal = Normalized(normal);
  numbers.lobe = HasLobe(texel);
  const auto reflectance = [&](std::size_t first, std::size_t c) {
    const double value = Value(first + (maps_.channels == 1 ? 0 : c), texel) / white_;
    return std::isnan(value) ? 0.0 : value;
  };
  for (std::size_t c = 0; c < 3; ++c) {
    numbers.diffuse[c] = reflectance(kDiffuse, c);
    if (numbers.lobe) numbers.f0[c] = reflectance(f0_, c);
  }
  if (!numbers.lobe) return numbers;
  const bool one = maps_.lobe == MapLobe::kGgx;
  const double x = Value(alpha_, texel), y = one ? x : Value(alpha_ + 1, texel);
  if (std::isnan(x) || std::isnan(y)) {
    numbers.lobe = false, numbers.f0 = {0, 0, 0};
    return numbers;
  }
  const bool known = !std::isnan(maps_.rows.values[alpha_][texel]);
  numbers.widths = known ? Widths{x, y} : Widths{std::sqrt(x * y), std::sqrt(x * y)};
  const double angle = one || !known ? 0 : static_cast<double>(maps_.rows.values[alpha_ + 2][texel]) * kPi / 180;
  if (x != y && known) numbers.rotation = AzimuthOf(numbers.normal, std::isnan(angle) ? 0 : angle);
  return numbers;
}

}  // namespace lobefit
