#include "lobefit/maps/report/pictures.h"

#include <algorithm>
#include <cmath>

#include "lobefit/plot/canvas.h"
#include "lobefit/plot/color.h"
#include "lobefit/plot/style.h"

namespace lobefit {
namespace {

// color(texel) for each texel within the mask.
template <class Color>
cv::Mat Picture(const Maps& maps, const Color& color) {
  const int width = static_cast<int>(maps.rows.width), height = static_cast<int>(maps.rows.rows);
  const std::vector<float>& status = maps.rows.values.back();
  cv::Mat picture(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t t = PixelIndex(x, y, width);
      const bool outside = (static_cast<unsigned>(status[t]) & kMapOutside) != 0;
      const Rgb c = outside ? style::kShade : color(t);
      picture.at<cv::Vec3b>(y, x) = {c.r, c.g, c.b};
    }
  }
  return picture;
}

constexpr Rgb kUnknown = {255, 255, 255};

Rgb Screen(double r, double g, double b) { return ToScreen({r, g, b}, 1); }

}  // namespace

cv::Mat NormalPicture(const Maps& maps) {
  return Picture(maps, [&](std::size_t t) {
    std::uint8_t bytes[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float v = maps.rows.values[axis][t];
      if (std::isnan(v)) return kUnknown;
      bytes[axis] = static_cast<std::uint8_t>(std::lround(255 * (static_cast<double>(v) + 1) / 2));
    }
    return Rgb{bytes[0], bytes[1], bytes[2]};
  });
}

cv::Mat ColorPicture(const Maps& maps, const std::string& head, double white) {
  const bool gray = maps.channels == 1;
  const std::size_t first = PlaneIndex(maps.planes, MapPart::kParameters, head + (gray ? "Y" : "R"));
  return Picture(maps, [&](std::size_t t) {
    double v[3];
    for (std::size_t c = 0; c < 3; ++c) v[c] = static_cast<double>(maps.rows.values[first + (gray ? 0 : c)][t]) / white;
    return std::isnan(v[0] + v[1] + v[2]) ? kUnknown : Screen(v[0], v[1], v[2]);
  });
}

cv::Mat ScalarPicture(const Maps& maps, MapPart part, const std::string& name, double low, double high,
                      bool logarithmic) {
  const std::vector<float>& plane = maps.rows.values[PlaneIndex(maps.planes, part, name)];
  return Picture(maps, [&](std::size_t t) {
    const auto v = static_cast<double>(plane[t]);
    if (std::isnan(v)) return kUnknown;
    const double at =
        logarithmic ? std::log(std::max(v, 1e-30) / low) / std::log(high / low) : (v - low) / (high - low);
    return SequentialColor(std::clamp(at, 0.0, 1.0));
  });
}

cv::Mat StatusPicture(const Maps& maps) {
  const std::vector<float>& status = maps.rows.values.back();
  return Picture(maps, [&](std::size_t t) {
    const auto bits = static_cast<unsigned>(status[t]);
    if ((bits & kMapTooFew) != 0) return style::kInk;
    if ((bits & kMapNotConverged) != 0) return style::kVermilion;
    if ((bits & kMapAtBound) != 0) return style::kOrange;
    if ((bits & kMapNotDetermined) != 0) return style::kPurple;
    if ((bits & kMapNoLobe) != 0) return style::kBlue;
    return style::kGreen;
  });
}

cv::Mat PhotoPicture(const std::vector<float>& image, const Maps& maps, double white) {
  const auto channels = static_cast<std::size_t>(maps.channels);
  return Picture(maps, [&](std::size_t t) {
    double v[3];
    for (std::size_t c = 0; c < 3; ++c) {
      v[c] = static_cast<double>(image[t * channels + (channels == 1 ? 0 : c)]) / white;
      if (std::isinf(v[c])) v[c] = 1;  // saturated
    }
    return std::isnan(v[0] + v[1] + v[2]) ? kUnknown : Screen(v[0], v[1], v[2]);
  });
}

double Percentile(const Maps& maps, MapPart part, const std::string& head, double share) {
  std::vector<float> values;
  for (std::size_t k = 0; k < maps.planes.size(); ++k) {
    if (maps.planes[k].part != part || maps.planes[k].name.rfind(head, 0) != 0) continue;
    std::copy_if(maps.rows.values[k].begin(), maps.rows.values[k].end(), std::back_inserter(values),
                 [](float v) { return std::isfinite(v); });
  }
  if (values.empty()) return kNan;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

}  // namespace lobefit
