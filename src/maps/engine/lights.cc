#include "lobefit/maps/engine/lights.h"

#include <cmath>

namespace lobefit {

void LightArrays::Resize(std::size_t lights) {
  const std::size_t most = (lights + kLanes - 1) / kLanes * kLanes;
  for (std::vector<double>* array : {&x, &y, &z, &h_x, &h_y, &h_z, &square, &k, &live}) array->resize(most);
  Close(lights);
}

void LightArrays::Set(std::size_t at, const Vec3& direction, bool schlick) {
  const Vec3 h = direction + Vec3{0, 0, 1};
  x[at] = direction.x, y[at] = direction.y, z[at] = direction.z;
  h_x[at] = h.x, h_y[at] = h.y, h_z[at] = h.z;
  square[at] = Dot(h, h);
  // |h| = 2 cos_d for unit directions.
  k[at] = schlick ? std::pow(1 - 0.5 * std::sqrt(square[at]), 5) : 0;
  live[at] = 1;
}

void LightArrays::Copy(const LightArrays& from, std::size_t index, std::size_t at) {
  x[at] = from.x[index], y[at] = from.y[index], z[at] = from.z[index];
  h_x[at] = from.h_x[index], h_y[at] = from.h_y[index], h_z[at] = from.h_z[index];
  square[at] = from.square[index], k[at] = from.k[index], live[at] = 1;
}

void LightArrays::Close(std::size_t lights) {
  count = lights;
  padded = (lights + kLanes - 1) / kLanes * kLanes;
  for (std::size_t at = lights; at < padded; ++at) {
    Set(at, {0, 0, 1}, true);
    live[at] = 0;
  }
}

}  // namespace lobefit
