#include "lobefit/maps/relight.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/ellipsoid/off_center.h"

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
  fallback.alpha = MedianOf(maps.rows.values[PlaneIndex(maps.planes, MapPart::kParameters, WidestAlpha(maps.lobe))]);
  return fallback;
}

RelitTexel RelitTexelAt(const Maps& maps, std::size_t texel, const Fallback& fallback) {
  const auto at = [&](std::size_t plane) { return static_cast<double>(maps.rows.values[plane][texel]); };
  const auto channels = static_cast<std::size_t>(maps.channels);
  const std::size_t diffuse = 3, f0 = diffuse + channels, alpha = f0 + channels;  // planes.h
  RelitTexel result;
  MapPoint& point = result.point;
  point.normal = {at(0), at(1), at(2)};
  result.hidden = std::isnan(point.normal.z);
  if (!result.hidden) point.normal = Normalized(point.normal);
  for (std::size_t c = 0; c < channels; ++c) point.diffuse[c] = at(diffuse + c);
  // Without a lobe by evidence all numbers of the lobe are NaN, and the status says so.
  const bool none = (static_cast<unsigned>(at(maps.planes.size() - 1)) & kMapNoLobe) != 0;
  if (maps.lobe == MapLobe::kNone || none) return result;
  const bool one = maps.lobe == MapLobe::kGgx;
  double x = at(alpha), y = one ? x : at(alpha + 1), angle = one ? 0 : at(alpha + 2) * kPi / 180;
  const bool leans = maps.lobe == MapLobe::kEllipsoid;
  double tilt[2] = {leans ? at(alpha + 3) * kPi / 180 : 0, leans ? at(alpha + 4) * kPi / 180 : 0};
  if (std::isnan(x + y + angle + tilt[0] + tilt[1])) x = y = fallback.alpha, angle = tilt[0] = tilt[1] = 0;
  point.width = one ? std::array<double, 3>{std::log(x), 0, std::log(x)} : WidthsOf(x, y, angle);
  if (leans && !std::isnan(x)) {
    const SlopeCoordinates slopes = SlopeCoordinatesFromEllipsoid({x, y, tilt[0], tilt[1], -angle});
    point.slope = {slopes.v[0], slopes.v[1]}, point.width = {slopes.v[2], slopes.v[3], slopes.v[4]};
  }
  bool known = !std::isnan(x);
  for (std::size_t c = 0; c < channels; ++c) {
    point.f0[c] = std::isnan(at(f0 + c)) ? fallback.f0[c] : at(f0 + c);
    known = known && !std::isnan(point.f0[c]);
  }
  if (known) result.lobe = maps.lobe;
  return result;
}

Relighting::Relighting(const Maps& maps, const LightPaths& paths, bool schlick, const Fallback& fallback)
    : maps_(maps), schlick_(schlick), fallback_(fallback) {
  lights_.Resize(paths.wi.size());
  Move(paths);
  shape_.Resize(lights_.padded);
}

void Relighting::Texel(std::size_t texel, double* values, std::size_t stride) {
  const RelitTexel relit = RelitTexelAt(maps_, texel, fallback_);
  if (!relit.hidden) EvaluateShape(relit.lobe, relit.point, lights_, false, &shape_);
  for (std::size_t c = 0; c < static_cast<std::size_t>(maps_.channels); ++c) {
    for (std::size_t l = 0; l < lights_.count; ++l) {
      double value = relit.hidden ? kNan : relit.point.diffuse[c] * kInvPi * shape_.cosine[l];
      if (!relit.hidden && relit.lobe != MapLobe::kNone) {
        value += (relit.point.f0[c] * (1 - lights_.k[l]) + lights_.k[l]) * shape_.specular[l];
      }
      values[c * stride + l] = value;
    }
  }
}

}  // namespace lobefit
