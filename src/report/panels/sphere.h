// Spheres under one light from the upper left and under a sky, as report and page draw them.
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
#include "lobefit/report/figures/isotropic_lookup.h"

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

  DirectionArrays arrays() const {
    return {d[0].data(), d[1].data(), d[2].data(), d[3].data(), d[4].data(), d[5].data(), pixel.size()};
  }
};
// Of a sphere of size x size pixels, whatever its material.
std::vector<LitRow> LitRows(int size);

// f_r[c][i] of directions above the horizon; known[i] == 0 where it is not known.
using ShownBrdf = std::function<void(const DirectionArrays& directions, std::vector<std::vector<double>>* f_r,
                                     std::vector<std::uint8_t>* known)>;
// They refer to what they show.
ShownBrdf Shown(const FittedFunction& fitted);
ShownBrdf Shown(const IsotropicLookup& lookup, std::size_t channels);

// A fit of more channels than a picture has colours, as one of R, G and B: of Fresnel terms and diffuse parts that are
// linear in what differs between channels a colour is that of a material with the colours' mean parameters. Of 800
// channels each direction took 800 Fresnel terms, and a report 10 s. Any other fit as it is.
struct ColoredFit {
  FittedFunction function;
  ChannelColor to_color;
};
ColoredFit InColors(const Material& material, const ChannelColor& to_color);

// Black, all known.
LitSphere DarkSphere(int size);
// Whether nearly all of the sphere is known.
bool IsCovered(const LitSphere& sphere);

// Towards the light; the viewer is at +z.
Vec3 SphereLight();
// `rows` as LitRows gives them.
LitSphere LightSphere(const ShownBrdf& brdf, const ChannelColor& to_color, std::size_t channels,
                      const std::vector<LitRow>& rows);
// The measured one; nothing where the measurement is not isotropic or does not speak for nearly the whole sphere.
std::optional<LitSphere> LightMeasured(const Measurement& measurement, const ChannelColor& to_color, int size);

// Under an analytic sky with a low sun, 104 pixels wide. Light comes from `count` directions, a multiple of 3: a third
// drawn from the density of slopes of `lobe`, a third by the cosine, a third around the sun, weighted by the balance
// heuristic; the same ones for any brdf, so that two spheres can be compared.
LitSphere SkySphere(const ShownBrdf& brdf, const SlopeCoordinates& lobe, const ChannelColor& to_color,
                    std::size_t channels, int count, int threads);

// Factor before ToScreen: highlights may saturate, but not so far that the rest is black.
double SphereExposure(const LitSphere& sphere);

}  // namespace lobefit
