#include "lobefit/io/bsdf_xml/radiance_color.h"

#include <algorithm>

namespace lobefit {
namespace {

using Rows = std::array<std::array<double, 3>, 3>;

// From the chromaticities above; the second is the inverse of the first.
constexpr Rows kXyzFromRgb = {{{0.5141446, 0.3238845, 0.1619709},    //
                               {0.2651058, 0.6701058, 0.0647884},    //
                               {0.0241005, 0.1228527, 0.8530467}}};  //
constexpr Rows kRgbFromXyz = {{{2.5653128, -1.1668496, -0.3984632},  //
                               {-1.0221082, 1.9782866, 0.0438216},   //
                               {0.0747244, -0.2519396, 1.1772152}}};

std::array<double, 3> Times(const Rows& rows, const std::array<double, 3>& v) {
  std::array<double, 3> result = {};
  for (std::size_t i = 0; i < 3; ++i) result[i] = rows[i][0] * v[0] + rows[i][1] * v[1] + rows[i][2] * v[2];
  return result;
}

}  // namespace

std::array<double, 3> RadianceYuv(const std::array<double, 3>& rgb) {
  const auto [x, y, z] = Times(kXyzFromRgb, rgb);
  const double sum = x + 15 * y + 3 * z;
  return sum > 0 ? std::array<double, 3>{y, 4 * x / sum, 9 * y / sum} : std::array<double, 3>{0, 4.0 / 19, 9.0 / 19};
}

std::array<double, 3> RadianceRgb(const std::array<double, 3>& yuv) {
  const auto [y, u, v] = yuv;
  std::array<double, 3> rgb = Times(kRgbFromXyz, {y * 9 * u / (4 * v), y, y * (12 - 3 * u - 20 * v) / (4 * v)});
  for (double& value : rgb) value = std::max(0.0, value);
  return rgb;
}

}  // namespace lobefit
