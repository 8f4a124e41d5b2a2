#include "lobefit/plot/color.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace lobefit {
namespace {

// A Gaussian whose width differs on both sides of its peak.
double SplitBell(double wavelength, double peak, double width_below, double width_above) {
  const double t = (wavelength - peak) / (wavelength < peak ? width_below : width_above);
  return std::exp(-0.5 * t * t);
}

// Colour matching functions, [Wyman et al. 2013, table 1, multi-lobe fit]; wavelength in nm.
std::array<double, 3> Observer(double wavelength) {
  const double x = 1.056 * SplitBell(wavelength, 599.8, 37.9, 31.0) + 0.362 * SplitBell(wavelength, 442.0, 16.0, 26.7) -
                   0.065 * SplitBell(wavelength, 501.1, 20.4, 26.2);
  const double y = 0.821 * SplitBell(wavelength, 568.8, 46.9, 40.5) + 0.286 * SplitBell(wavelength, 530.9, 16.3, 31.1);
  const double z = 1.217 * SplitBell(wavelength, 437.0, 11.8, 36.0) + 0.681 * SplitBell(wavelength, 459.0, 26.0, 13.8);
  return {x, y, z};
}

std::array<double, 3> ToRgb(const std::array<double, 3>& xyz) {
  return {3.2406255 * xyz[0] - 1.537208 * xyz[1] - 0.4986286 * xyz[2],
          -0.9689307 * xyz[0] + 1.8757561 * xyz[1] + 0.0415175 * xyz[2],
          0.0557101 * xyz[0] - 0.2040211 * xyz[1] + 1.0569959 * xyz[2]};
}

}  // namespace

ChannelColor::ChannelColor(const Channels& channels) {
  const std::size_t count = channels.size();
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, count));
  weights_.assign(count, {share, share, share});
  if (channels.names == std::vector<std::string>{"R", "G", "B"}) {
    weights_ = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  } else if (channels.names == std::vector<std::string>{"X", "Y", "Z"}) {
    weights_ = {ToRgb({1, 0, 0}), ToRgb({0, 1, 0}), ToRgb({0, 0, 1})};
  } else if (count >= 3 && channels.wavelengths_nm.size() == count) {
    std::array<double, 3> white = {0, 0, 0};
    std::vector<std::array<double, 3>> rgb;
    for (std::size_t c = 0; c < count; ++c) {
      // Width of the band that the channel stands for.
      const double below = c > 0 ? channels.wavelengths_nm[c - 1] : channels.wavelengths_nm[c];
      const double above = c + 1 < count ? channels.wavelengths_nm[c + 1] : channels.wavelengths_nm[c];
      std::array<double, 3> xyz = Observer(channels.wavelengths_nm[c]);
      for (double& v : xyz) v *= std::fabs(above - below) / 2;
      rgb.push_back(ToRgb(xyz));
      for (std::size_t k = 0; k < 3; ++k) white[k] += rgb.back()[k];
    }
    // Bands outside the visible leave nothing to be coloured.
    if (*std::min_element(white.begin(), white.end()) > 1) {
      for (std::array<double, 3>& weight : rgb) {
        for (std::size_t k = 0; k < 3; ++k) weight[k] /= white[k];
      }
      weights_ = rgb;
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
