// Spheres under one light from the upper left, as report and page draw them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/plot/color.h"
#include "lobefit/report/figures/fitted_function.h"

namespace lobefit {

// Row-major linear colours of size x size pixels, first row at the top; known[i] == 0 where the measurement says
// nothing.
struct LitSphere {
  int size = 0;
  std::vector<std::array<double, 3>> color;
  std::vector<std::uint8_t> known;
};

// The pixels of a row that see the light, with both directions in the frame of their point.
struct LitRow {
  std::vector<std::size_t> pixel;
  std::array<std::vector<double>, 6> d;  // wi.x ... wo.z

  Vec3 wi(std::size_t i) const { return {d[0][i], d[1][i], d[2][i]}; }
  Vec3 wo(std::size_t i) const { return {d[3][i], d[4][i], d[5][i]}; }
};
// Of a sphere of size x size pixels, whatever its material.
std::vector<LitRow> LitRows(int size);

// f_r of one pair of directions; false where it is not known.
using ShownBrdf = std::function<bool(const Vec3& wi, const Vec3& wo, double* f_r)>;

// Towards the light; the viewer is at +z.
Vec3 SphereLight();
LitSphere LightSphere(const ShownBrdf& brdf, const ChannelColor& to_color, std::size_t channels, int size);
// The same of what was fitted, many pixels at once; `rows` as LitRows gives them.
LitSphere LightFitted(const FittedFunction& fitted, const ChannelColor& to_color, const std::vector<LitRow>& rows);
// The measured one; nothing where the measurement is not isotropic or does not speak for nearly the whole sphere.
std::optional<LitSphere> LightMeasured(const Measurement& measurement, const ChannelColor& to_color, int size);

// Under an analytic sky with a low sun, 104 pixels wide. Light comes from `count` directions: a third
// drawn from the density of slopes of `lobe`, a third by the cosine, a third around the sun, weighted by the balance
// heuristic; the same ones for any brdf, so that two spheres can be compared.
LitSphere SkySphere(const ShownBrdf& brdf, const SlopeCoordinates& lobe, const ChannelColor& to_color,
                    std::size_t channels, int count, int threads);

// Factor before ToScreen: highlights may saturate, but not so far that the rest is black.
double SphereExposure(const LitSphere& sphere);

}  // namespace lobefit
