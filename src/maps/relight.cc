#include "lobefit/maps/relight.h"

#include <algorithm>
#include <cmath>

namespace lobefit {
namespace {

double MedianOf(const std::vector<float>& plane) {
  std::vector<float> finite;
  std::copy_if(plane.begin(), plane.end(), std::back_inserter(finite), [](float v) { return std::isfinite(v); });
  if (finite.empty()) return kNan;
  const auto middle = finite.begin() + static_cast<std::ptrdiff_t>(finite.size() / 2);
  std::nth_element(finite.begin(), middle, finite.end());
  return static_cast<double>(*middle);
}

// L = (a 0; b c) of widths along axes turned by `angle`.
std::array<double, 3> WidthsOf(double alpha_x, double alpha_y, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), x = alpha_x * alpha_x, y = alpha_y * alpha_y;
  const double xx = c * c * x + s * s * y, xy = c * s * (x - y), yy = s * s * x + c * c * y;
  const double a = std::sqrt(xx), b = xy / a;
  return {std::log(a), b, 0.5 * std::log(yy - b * b)};
}

}  // namespace

Fallback MedianFallback(const Maps& maps) {
  Fallback fallback;
  if (maps.lobe == MapLobe::kNone) return fallback;
  const std::size_t f0 = PlaneIndex(maps.planes, MapPart::kParameters, maps.channels == 1 ? "f0.Y" : "f0.R");
  for (int c = 0; c < maps.channels; ++c) fallback.f0[c] = MedianOf(maps.rows.values[f0 + static_cast<std::size_t>(c)]);
  const char* alpha = maps.lobe == MapLobe::kGgx ? "alpha" : "alpha_x";
  fallback.alpha = MedianOf(maps.rows.values[PlaneIndex(maps.planes, MapPart::kParameters, alpha)]);
  return fallback;
}

Relighting::Relighting(const Maps& maps, const std::vector<Vec3>& lights, bool schlick, const Fallback& fallback)
    : maps_(maps), fallback_(fallback) {
  lights_.Resize(lights.size());
  for (std::size_t l = 0; l < lights.size(); ++l) lights_.Set(l, lights[l], schlick);
  shape_.Resize(lights_.padded);
  normal_ = 0, diffuse_ = 3, f0_ = diffuse_ + static_cast<std::size_t>(maps.channels);
  alpha_ = f0_ + static_cast<std::size_t>(maps.channels);
}

void Relighting::Texel(std::size_t texel, double* values, std::size_t stride) {
  const auto at = [&](std::size_t plane) { return static_cast<double>(maps_.rows.values[plane][texel]); };
  MapPoint point;
  point.normal = {at(normal_), at(normal_ + 1), at(normal_ + 2)};
  MapLobe lobe = maps_.lobe;
  bool undetermined = false;
  // Without a lobe by evidence all numbers of the lobe are NaN, and the status says so.
  const std::size_t status = maps_.planes.size() - 1;
  const bool none = (static_cast<unsigned>(at(status)) & kMapNoLobe) != 0;
  if (lobe != MapLobe::kNone && !none) {
    const bool one = lobe == MapLobe::kGgx;
    double x = at(alpha_), y = one ? x : at(alpha_ + 1), angle = one ? 0 : at(alpha_ + 2) * kPi / 180;
    if (std::isnan(x) || std::isnan(y) || std::isnan(angle)) x = y = fallback_.alpha, angle = 0;
    point.width = one ? std::array<double, 3>{std::log(x), 0, std::log(x)} : WidthsOf(x, y, angle);
    undetermined = std::isnan(x);
    for (std::size_t c = 0; c < static_cast<std::size_t>(maps_.channels); ++c) {
      point.f0[c] = std::isnan(at(f0_ + c)) ? fallback_.f0[c] : at(f0_ + c);
      undetermined = undetermined || std::isnan(point.f0[c]);
    }
  }
  if (none || undetermined) lobe = MapLobe::kNone;
  const bool hidden = std::isnan(point.normal.z);
  if (!hidden) {
    point.normal = Normalized(point.normal);
    EvaluateShape(lobe, point, lights_, false, &shape_);
  }
  for (std::size_t c = 0; c < static_cast<std::size_t>(maps_.channels); ++c) {
    for (std::size_t l = 0; l < lights_.count; ++l) {
      double value = hidden ? kNan : at(diffuse_ + c) * kInvPi * shape_.cosine[l];
      if (!hidden && lobe != MapLobe::kNone) {
        value += (point.f0[c] * (1 - lights_.k[l]) + lights_.k[l]) * shape_.specular[l];
      }
      values[c * stride + l] = value;
    }
  }
}

}  // namespace lobefit
