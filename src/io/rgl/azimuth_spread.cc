#include "lobefit/io/rgl/azimuth_spread.h"

#include <algorithm>
#include <array>
#include <vector>

#include "lobefit/math/directions.h"

namespace lobefit {

AzimuthSpread SpreadAtNormal(const RglBrdf& brdf) {
  constexpr std::size_t kAxes = 6;
  AzimuthSpread spread;
  std::vector<double> values(brdf.channels().size());
  for (const double degrees : {10.0, 20.0}) {
    std::array<double, kAxes> axes = {};
    for (std::size_t k = 0; k < 2 * kAxes; ++k) {
      const double azimuth = kPi * static_cast<double>(k) / kAxes;
      brdf.Evaluate(FromSpherical(DegreesToRadians(degrees), azimuth), {0, 0, 1}, values.data());
      for (const double value : values) axes[k % kAxes] += value;
    }
    const auto largest = std::max_element(axes.begin(), axes.end());
    const double smallest = *std::min_element(axes.begin(), axes.end());
    if (!(smallest > 0) || *largest / smallest <= spread.ratio) continue;
    spread.ratio = *largest / smallest;
    spread.largest = kPi * static_cast<double>(largest - axes.begin()) / kAxes;
  }
  return spread;
}

}  // namespace lobefit
