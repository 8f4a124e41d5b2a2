#include "lobefit/measurement/prepare/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/math/statistics.h"

namespace lobefit {
namespace {

// A stretch of a scan. White noise of standard deviation 1 has second differences of variance 6, most of them of
// another sign than the one before; a lobe, however steep, has second differences that keep their sign for long.
struct Stretch {
  double mean, noise, mean_square;
  int alternations;
};
Stretch DescribeStretch(const double* values, std::size_t count) {
  Stretch stretch = {};
  const double n = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    stretch.mean += values[i] / n;
    stretch.mean_square += values[i] * values[i] / n;
  }
  double squares = 0, last = 0;
  for (std::size_t i = 0; i + 2 < count; ++i) {
    const double second = values[i] - 2 * values[i + 1] + values[i + 2];
    squares += second * second;
    if (second * last < 0) ++stretch.alternations;
    last = second;
  }
  stretch.noise = std::sqrt(squares / (n - 2) / 6);
  return stretch;
}

}  // namespace

void AddSigma(const std::vector<double>& sigma, Samples* samples) {
  if (samples->sigma.empty()) samples->sigma.assign(samples->size(), 0.0);
  for (std::size_t i = 0; i < sigma.size(); ++i) samples->sigma[i] = std::hypot(samples->sigma[i], sigma[i]);
}

void AddNoiseFloor(double floor, Samples* samples) {
  std::vector<double> sigma;
  for (const double cos_i : samples->wi_z) sigma.push_back(floor / cos_i);
  AddSigma(sigma, samples);
}

std::optional<RectifiedNoise> FindRectifiedNoise(const Measurement& measurement) {
  // Half a normal distribution has a scatter of 0.76 of its mean; below a third the sign would not be lost.
  constexpr double kLeastRatio = 0.35;
  constexpr double kNearby = 5 * kPi / 180;
  constexpr std::size_t kLength = 8, kLeastStretches = 3;
  constexpr int kLeastAlternations = 3;
  const Samples& samples = measurement.samples;
  if (samples.size() < kLength) return std::nullopt;
  const auto reading = [&](std::size_t i) { return samples.values[0][i] * samples.wi_z[i]; };
  double largest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (reading(i) < 0) return std::nullopt;  // the sign was kept
    largest = std::max(largest, reading(i));
  }
  const auto near = [](const Vec3& a, const Vec3& b) { return Dot(a - b, a - b) < kNearby * kNearby; };
  std::vector<double> mean_squares;
  std::size_t begin = 0;
  while (begin + kLength <= samples.size()) {
    std::size_t end = begin + 1;
    while (end < begin + kLength && near(samples.wi(end), samples.wi(end - 1)) &&
           near(samples.wo(end), samples.wo(end - 1)))
      ++end;
    if (end < begin + kLength) {
      begin = end;
      continue;
    }
    std::array<double, kLength> readings = {};
    for (std::size_t k = 0; k < kLength; ++k) readings[k] = reading(begin + k);
    const Stretch stretch = DescribeStretch(readings.data(), kLength);
    if (stretch.noise > kLeastRatio * stretch.mean && stretch.alternations >= kLeastAlternations && stretch.mean > 0 &&
        stretch.mean < 0.02 * largest) {
      mean_squares.push_back(stretch.mean_square);
    }
    begin += kLength / 2;
  }
  if (mean_squares.size() < kLeastStretches) return std::nullopt;
  RectifiedNoise noise;
  noise.floor = std::sqrt(Median(mean_squares));
  for (std::size_t i = 0; i < samples.size(); ++i) noise.samples_below += reading(i) < 3 * noise.floor ? 1 : 0;
  return noise;
}

}  // namespace lobefit
