#include "lobefit/maps/report/web/data.h"

#include <algorithm>
#include <cmath>

#include <Imath/half.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/base64.h"
#include "lobefit/maps/report/tiles.h"
#include "lobefit/maps/report/web/html.h"

namespace lobefit {
namespace {

void Append(double value, std::string* bytes) {
  const std::uint16_t bits = half(static_cast<float>(value)).bits();
  bytes->push_back(static_cast<char>(bits & 255U)), bytes->push_back(static_cast<char>(bits >> 8U));
}

double ExposureUnder(const Maps& maps, const Stack& stack, const MapsPage& page, const Vec3& light) {
  Relighting relighting(maps, {light}, stack.calibrated, page.fallback);
  std::vector<double> finite;
  for (std::size_t t = 0; t < maps.rows.rows * maps.rows.width; ++t) {
    double values[kMostChannels];
    relighting.Texel(t, values, 1);
    for (int c = 0; c < maps.channels; ++c) {
      if (std::isfinite(values[c])) finite.push_back(values[c]);
    }
  }
  if (finite.empty()) return 1;
  const auto at = finite.begin() + static_cast<std::ptrdiff_t>((finite.size() - 1) * 99 / 100);
  std::nth_element(finite.begin(), at, finite.end());
  return *at > 0 ? 1 / *at : 1;
}

}  // namespace

std::size_t LiveStep(const Maps& maps) {
  return (std::max(maps.rows.width, maps.rows.rows) + kLiveSide - 1) / kLiveSide;
}

std::string LiveData(const Maps& maps, const Stack& stack, const MapsPage& page, std::size_t step) {
  std::string normals, diffuses, mirrors, lasts;
  const std::size_t width = (maps.rows.width + step - 1) / step, height = (maps.rows.rows + step - 1) / step;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const RelitTexel texel = RelitTexelAt(maps, y * step * maps.rows.width + x * step, page.fallback);
      const MapPoint& point = texel.point;
      const bool lobe = texel.lobe != MapLobe::kNone;
      const auto color = [&](const std::array<double, kMostChannels>& values, double last, std::string* bytes) {
        for (std::size_t c = 0; c < 3; ++c) Append(values[maps.channels == 1 ? 0 : c], bytes);
        Append(last, bytes);
      };
      color({point.normal.x, point.normal.y, point.normal.z}, texel.hidden ? -1 : lobe ? 1 : 0, &normals);
      color(point.diffuse, std::exp(point.width[0]), &diffuses);
      color(point.f0, point.width[1], &mirrors);
      Append(std::exp(point.width[2]), &lasts);
    }
  }
  // What was left out tells most; else what is met worst.
  const RelitLight* shown = WorstLight(page.lights, false);
  if (shown == nullptr) shown = WorstLight(page.lights, true);
  const std::size_t first = shown == nullptr ? 0 : shown->light;
  nlohmann::ordered_json lights = nlohmann::ordered_json::array();
  for (const StackLight& light : stack.lights) {
    lights.push_back({light.direction.x, light.direction.y, light.direction.z});
  }
  return nlohmann::ordered_json{{"width", width},
                                {"height", height},
                                {"schlick", stack.calibrated},
                                {"first", first},
                                {"exposure", ExposureUnder(maps, stack, page, stack.lights[first].direction)},
                                {"lights", lights},
                                {"normals", Base64(normals)},
                                {"diffuses", Base64(diffuses)},
                                {"mirrors", Base64(mirrors)},
                                {"lasts", Base64(lasts)}}
      .dump();
}

}  // namespace lobefit
