#include "lobefit/maps/engine/lights.h"

#include <cmath>

namespace lobefit {

void LightArrays::Resize(std::size_t lights) {
  const std::size_t most = (lights + kLanes - 1) / kLanes * kLanes;
  for (LightVector* array : {&x, &y, &z, &out_x, &out_y, &out_z, &square, &k, &live}) array->resize(most);
  Close(lights);
}

void LightArrays::Set(const LightPaths& paths, bool schlick) {
  from_z = paths.wo.empty();
  for (std::size_t l = 0; l < paths.wi.size(); ++l) Set(l, paths.wi[l], from_z ? Vec3{0, 0, 1} : paths.wo[l], schlick);
}

void LightArrays::Set(std::size_t at, const Vec3& wi, const Vec3& wo, bool schlick) {
  const Vec3 h = wi + wo;
  x[at] = wi.x, y[at] = wi.y, z[at] = wi.z;
  out_x[at] = wo.x, out_y[at] = wo.y, out_z[at] = wo.z;
  square[at] = Dot(h, h);
  // |h| = 2 cos_d for unit directions.
  k[at] = schlick ? std::pow(1 - 0.5 * std::sqrt(square[at]), 5) : 0;
  live[at] = 1;
}

void LightArrays::Copy(const LightArrays& from, std::size_t index, std::size_t at) {
  x[at] = from.x[index], y[at] = from.y[index], z[at] = from.z[index];
  out_x[at] = from.out_x[index], out_y[at] = from.out_y[index], out_z[at] = from.out_z[index];
  square[at] = from.square[index], k[at] = from.k[index], live[at] = 1;
}

void LightArrays::Close(std::size_t lights) {
  count = lights;
  padded = (lights + kLanes - 1) / kLanes * kLanes;
  for (std::size_t at = lights; at < padded; ++at) {
    x[at] = y[at] = out_x[at] = out_y[at] = k[at] = live[at] = 0;
    z[at] = out_z[at] = 1, square[at] = 4;
  }
}

}  // namespace lobefit
