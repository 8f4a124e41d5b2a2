#include "lobefit/plot/color.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "lobefit/measurement/spectrum.h"

namespace lobefit {

ChannelColor::ChannelColor(const Channels& channels) {
  const std::size_t count = channels.size();
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, count));
  weights_.assign(count, {share, share, share});
  if (channels.names == std::vector<std::string>{"R", "G", "B"}) {
    weights_ = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  } else if (channels.names == std::vector<std::string>{"X", "Y", "Z"} || CoversVisible(channels.wavelengths_nm)) {
    // As `--channels rgb` takes it. What does not cover the visible has no colour: the channels' mean, in grey.
    const ChannelMap map = MakeChannelMap("rgb", channels);
    for (std::size_t c = 0; c < count; ++c) {
      for (std::size_t k = 0; k < 3; ++k) weights_[c][k] = map.matrix[k][c];
    }
  }
}

std::array<double, 3> ChannelColor::Linear(const double* values) const {
  std::array<double, 3> rgb = {0, 0, 0};
  for (std::size_t c = 0; c < weights_.size(); ++c) {
    for (std::size_t k = 0; k < 3; ++k) rgb[k] += weights_[c][k] * values[c];
  }
  return rgb;
}

Rgb ToScreen(const std::array<double, 3>& linear, double exposure) {
  const auto curve = [exposure](double v) {
    double x = std::max(0.0, v * exposure);
    constexpr double kKnee = 0.7;
    if (x > kKnee) x = kKnee + (1 - kKnee) * (1 - std::exp(-(x - kKnee) / (1 - kKnee)));
    const double s = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(s, 0.0, 1.0)));
  };
  return {curve(linear[0]), curve(linear[1]), curve(linear[2])};
}

}  // namespace lobefit
