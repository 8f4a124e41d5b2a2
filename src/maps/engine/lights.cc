#include "lobefit/maps/engine/lights.h"

#include <cmath>

namespace lobefit {

void LightArrays::Resize(std::size_t lights) {
  const std::size_t most = (lights + kLanes - 1) / kLanes * kLanes;
  for (LightVector* array : {&x, &y, &z, &square, &k, &live}) array->resize(most);
  Close(lights);
}

void LightArrays::Set(std::size_t at, const Vec3& direction, bool schlick) {
  const Vec3 h = direction + Vec3{0, 0, 1};
  x[at] = direction.x, y[at] = direction.y, z[at] = direction.z;
  square[at] = Dot(h, h);
  // |h| = 2 cos_d for unit directions.
  k[at] = schlick ? std::pow(1 - 0.5 * std::sqrt(square[at]), 5) : 0;
  live[at] = 1;
}

void LightArrays::Copy(const LightArrays& from, std::size_t index, std::size_t at) {
  x[at] = from.x[index], y[at] = from.y[index], z[at] = from.z[index];
  square[at] = from.square[index], k[at] = from.k[index], live[at] = 1;
}

void LightArrays::Close(std::size_t lights) {
  count = lights;
  padded = (lights + kLanes - 1) / kLanes * kLanes;
  for (std::size_t at = lights; at < padded; ++at) {
    x[at] = y[at] = k[at] = live[at] = 0;
    z[at] = 1, square[at] = 4;
  }
}

}  // namespace lobefit
