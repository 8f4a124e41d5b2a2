// How a material looks, and how far that is from how its measurement looks.
#pragma once

#include <utility>

#include "lobefit/report/panels/sphere.h"

namespace lobefit {

// Spheres of a material under a point light and under a sky.
struct Look {
  LitSphere light, sky;
};

// `lobe`: where the directions of the sky's light are drawn from; the same for looks that are compared. Three channels.
Look Render(const ShownBrdf& brdf, const SlopeCoordinates& lobe, const ChannelColor& to_color);

// Peak signal-to-noise ratio in dB of the linear, exposed pictures clipped at white, and the mean CIE 1976 colour
// difference; seen from up to 75 degrees: further out the tables are known to be too dark, and the fits leave samples
// beyond 80 degrees out.
std::pair<double, double> CompareSpheres(const LitSphere& table, const LitSphere& fit);

}  // namespace lobefit
