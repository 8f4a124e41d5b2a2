#include "lobefit/maps/report/web/data.h"

#include <algorithm>
#include <cmath>

#include <Imath/half.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/text/base64.h"
#include "lobefit/maps/report/tiles.h"
#include "lobefit/maps/report/web/html.h"
#include "lobefit/maps/stack/geometry.h"

namespace lobefit {
namespace {

void Append(double value, std::string* bytes) {
  const std::uint16_t bits = half(static_cast<float>(value)).bits();
  bytes->push_back(static_cast<char>(bits & 255U)), bytes->push_back(static_cast<char>(bits >> 8U));
}

// Of the photograph, with what near lights lose on their way.
double ExposureUnder(const Maps& maps, const Stack& stack, const MapsPage& page, std::size_t light) {
  LightPaths paths;
  PathsAt(stack, {light}, 0, &paths);
  Relighting relighting(maps, paths, stack.calibrated, page.fallback);
  std::vector<double> finite;
  for (std::size_t t = 0; t < maps.rows.rows * maps.rows.width; ++t) {
    if (stack.MovesPaths()) {
      PathsAt(stack, {light}, t, &paths);
      relighting.Move(paths);
    }
    double values[kMostChannels];
    relighting.Texel(t, values, 1);
    for (int c = 0; c < maps.channels; ++c) {
      if (std::isfinite(values[c])) finite.push_back(values[c] * IrradianceAt(stack, light, t));
    }
  }
  if (finite.empty()) return 1;
  const auto at = finite.begin() + static_cast<std::ptrdiff_t>((finite.size() - 1) * 99 / 100);
  std::nth_element(finite.begin(), at, finite.end());
  return *at > 0 ? 1 / *at : 1;
}

nlohmann::ordered_json PlaceOf(const Vec3& v) { return {v.x, v.y, v.z}; }

// Where near lights are and what becomes of their light; null of distant ones.
nlohmann::ordered_json NearData(const Stack& stack) {
  if (!stack.near) return nullptr;
  const NearLights& near = *stack.near;
  nlohmann::ordered_json distances = nlohmann::ordered_json::array();
  for (const StackLight& light : stack.lights) distances.push_back(Norm(light.place));
  return {{"reference", near.reference_mm},
          {"distances", distances},
          {"fall", {near.inverse_square ? near.reference_mm * near.reference_mm : 0, near.exponent}}};
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
      for (const double v : {std::exp(point.width[2]), point.slope[0], point.slope[1], 0.0}) Append(v, &lasts);
    }
  }
  // What was left out tells most; else what is met worst.
  const RelitLight* shown = WorstLight(page.lights, false);
  if (shown == nullptr) shown = WorstLight(page.lights, true);
  const std::size_t first = shown == nullptr ? 0 : shown->light;
  nlohmann::ordered_json lights = nlohmann::ordered_json::array(), cameras = nlohmann::ordered_json::array();
  for (const StackLight& light : stack.lights) lights.push_back(PlaceOf(light.direction));
  for (const Vec3& camera : stack.cameras) cameras.push_back(PlaceOf(camera));
  const double pitch = stack.width_mm / static_cast<double>(stack.width);
  return nlohmann::ordered_json{{"width", width},
                                {"height", height},
                                {"schlick", stack.calibrated},
                                {"first", first},
                                {"exposure", ExposureUnder(maps, stack, page, first)},
                                {"grid",
                                 {pitch, static_cast<double>(step), 0.5 * static_cast<double>(stack.width),
                                  0.5 * static_cast<double>(stack.height)}},
                                {"lights", lights},
                                {"near", NearData(stack)},
                                {"cameras", cameras},
                                {"normals", Base64(normals)},
                                {"diffuses", Base64(diffuses)},
                                {"mirrors", Base64(mirrors)},
                                {"lasts", Base64(lasts)}}
      .dump();
}

}  // namespace lobefit
