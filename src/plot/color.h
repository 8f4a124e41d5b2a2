// Linear colours of channels, and their way to the screen.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "lobefit/measurement/measurement.h"
#include "lobefit/plot/canvas.h"

namespace lobefit {

// Linear sRGB primaries from any set of channels: as MakeChannelMap("rgb") takes R, G, B, X, Y, Z and wavelengths that
// cover the visible; else grey, the mean of the channels.
class ChannelColor {
 public:
  explicit ChannelColor(const Channels& channels);
  explicit ChannelColor(std::vector<std::array<double, 3>> weights) : weights_(std::move(weights)) {}
  std::array<double, 3> Linear(const double* values) const;
  // Of a channel whose value is 1, the others 0.
  const std::array<double, 3>& OfChannel(std::size_t channel) const { return weights_[channel]; }

 private:
  std::vector<std::array<double, 3>> weights_;  // one a channel
};

// Exposure and a soft shoulder (values up to 0.7 are kept), then the sRGB curve.
Rgb ToScreen(const std::array<double, 3>& linear, double exposure);

}  // namespace lobefit
