// Linear colours of channels, and their way to the screen.
#pragma once

#include <array>
#include <vector>

#include "lobefit/measurement/measurement.h"
#include "lobefit/plot/canvas.h"

namespace lobefit {

// Linear sRGB primaries from any set of channels: R, G, B as they are; X, Y, Z by the matrix of IEC 61966-2-1;
// wavelengths by the CIE 1931 observer in the analytic form of [Wyman, Sloan, Shirley 2013], under light of equal
// energy, scaled so that a white reflectance is white; else grey, the mean of the channels.
class ChannelColor {
 public:
  explicit ChannelColor(const Channels& channels);
  std::array<double, 3> Linear(const double* values) const;

 private:
  std::vector<std::array<double, 3>> weights_;  // one a channel
};

// Exposure and a soft shoulder (values up to 0.7 are kept), then the sRGB curve.
Rgb ToScreen(const std::array<double, 3>& linear, double exposure);

}  // namespace lobefit
