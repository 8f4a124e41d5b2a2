#include "lobefit/maps/engine/lights.h"

#include <algorithm>
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

void LightArrays::Take(const LightArrays& from, const std::vector<std::size_t>& index) {
  from_z = from.from_z;
  const auto take = [&](const LightVector& all, LightVector* some) {
    for (std::size_t i = 0; i < index.size(); ++i) (*some)[i] = all[index[i]];
  };
  take(from.x, &x), take(from.y, &y), take(from.z, &z);
  take(from.out_x, &out_x), take(from.out_y, &out_y), take(from.out_z, &out_z);
  take(from.square, &square), take(from.k, &k);
  std::fill(live.begin(), live.begin() + static_cast<std::ptrdiff_t>(index.size()), 1.0);
  Close(index.size());
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
