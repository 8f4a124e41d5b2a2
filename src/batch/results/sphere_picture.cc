#include "lobefit/batch/results/sphere_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "lobefit/math/vec.h"
#include "lobefit/plot/color.h"
#include "lobefit/plot/png.h"
#include "lobefit/report/figures/fitted_function.h"
#include "lobefit/report/figures/isotropic_lookup.h"
#include "lobefit/report/panels/sphere.h"

namespace lobefit {
namespace {

constexpr int kSize = 64;

// The samples whose half angle is near that of the spheres' light and view, which is the same all over a sphere: they
// decide what is seen, and are a few hundredths of a table.
Measurement NearLight(const Measurement& measurement) {
  const double cos_theta_d = std::sqrt((1 + Dot(SphereLight(), Vec3{0, 0, 1})) / 2);
  const double theta_d = std::acos(cos_theta_d), reach = DegreesToRadians(2.5);
  const double nearest = std::cos(2 * (theta_d - reach)), farthest = std::cos(2 * (theta_d + reach));
  const Samples& samples = measurement.samples;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double cosine =
        samples.wi_x[i] * samples.wo_x[i] + samples.wi_y[i] * samples.wo_y[i] + samples.wi_z[i] * samples.wo_z[i];
    if (cosine <= nearest && cosine >= farthest) indices.push_back(i);
  }
  Measurement near;
  near.channels = measurement.channels;
  near.isotropic = measurement.isotropic;
  near.samples = samples.Subset(indices);
  return near;
}

// A channel on the screen without the last two bits, which are not seen in so small a picture, and would make it half
// as long again: a page holds a thousand.
class CoarseScreen {
 public:
  CoarseScreen() {
    for (std::size_t level = 1; level <= kLevels; ++level) least_[level - 1] = LeastOf(level);
    for (std::size_t step = 0; step < level_.size(); ++step)
      level_[step] = LevelsUpTo(static_cast<double>(step) / kSteps);
  }
  std::uint8_t Of(double linear) const {
    // Beyond the steps, or not a number.
    const bool is_far = !(linear < kMost);
    std::size_t level = is_far ? LevelsUpTo(linear) : level_[static_cast<std::size_t>(std::max(0.0, linear) * kSteps)];
    while (level < kLevels && least_[level] <= linear) ++level;
    return static_cast<std::uint8_t>(std::min<std::size_t>(255, 4 * level));
  }

 private:
  static constexpr std::size_t kLevels = 64;
  static constexpr double kMost = 2, kSteps = 256;  // steps of 1 / kSteps up to kMost

  static std::size_t LevelOf(double linear) { return (ToScreen({linear, linear, linear}, 1).r + 2U) / 4U; }
  std::size_t LevelsUpTo(double linear) const {
    return static_cast<std::size_t>(std::upper_bound(least_.begin(), least_.end(), linear) - least_.begin());
  }
  // The least number that is shown by this level. To look it up takes a fraction of the time of ToScreen, which rises.
  static double LeastOf(std::size_t level) {
    double below = 0, above = 1e3;
    for (double middle = 0.5 * above; below < middle && middle < above; middle = below + 0.5 * (above - below))
      (LevelOf(middle) < level ? below : above) = middle;
    return above;
  }

  std::array<double, kLevels> least_ = {};
  std::array<std::size_t, static_cast<std::size_t>(kMost* kSteps)> level_ = {};  // of where each step begins
};

void Paint(const LitSphere& sphere, double exposure, int left, cv::Mat* picture) {
  static const CoarseScreen screen;
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const std::size_t pixel = static_cast<std::size_t>(row) * kSize + static_cast<std::size_t>(column);
      const double x = column + 0.5 - kSize / 2.0, y = row + 0.5 - kSize / 2.0;
      cv::Vec3b& at = picture->at<cv::Vec3b>(row, left + column);
      at = {255, 255, 255};
      if (x * x + y * y > kSize * kSize / 4.0) continue;
      at = {150, 158, 167};
      if (sphere.known[pixel] == 0) continue;
      const std::array<double, 3>& color = sphere.color[pixel];
      at = {screen.Of(color[0] * exposure), screen.Of(color[1] * exposure), screen.Of(color[2] * exposure)};
    }
  }
}

}  // namespace

SpherePicture DrawSpheres(const Material& material, const Measurement& measurement) {
  if (material.sel) return {};
  const FittedFunction function(material);
  const ChannelColor to_color(measurement.channels);
  static const std::vector<LitRow> rows = LitRows(kSize);
  const LitSphere fitted = LightSphere(Shown(function), to_color, function.channels(), rows);
  std::optional<LitSphere> measured;
  if (measurement.isotropic) measured = LightMeasured(NearLight(measurement), to_color, kSize);
  const double exposure = SphereExposure(measured ? *measured : fitted);
  cv::Mat picture(kSize, measured ? 2 * kSize : kSize, CV_8UC3);
  if (measured) Paint(*measured, exposure, 0, &picture);
  Paint(fitted, exposure, measured ? kSize : 0, &picture);
  return {EncodePng(picture, 0), measured.has_value()};
}

}  // namespace lobefit
