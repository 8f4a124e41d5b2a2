// The lights of a stack as the fit takes them, and the part of them that a texel uses.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/math/vec.h"

namespace lobefit {

// Arrays of `count` lights, padded to a multiple of kLanes by lights along z whose `live` is 0. h = wi + wo with wo =
// +z, square = |h|^2; k is Schlick's (1 - cos_d)^5.
struct LightArrays {
  static constexpr std::size_t kLanes = 4;
  std::size_t count = 0, padded = 0;
  std::vector<double> x, y, z, h_x, h_y, h_z, square, k, live;

  void Resize(std::size_t lights);
  void Set(std::size_t at, const Vec3& direction, bool schlick);
  void Copy(const LightArrays& from, std::size_t index, std::size_t at);
  // Makes the lights from `lights` on padding.
  void Close(std::size_t lights);
};

// Sum of f(light) over the padded lights, in an order that does not depend on the instruction set.
template <class F>
double SumOverLights(std::size_t padded, const F& f) {
  double lanes[LightArrays::kLanes] = {};
  for (std::size_t l = 0; l < padded; l += LightArrays::kLanes) {
    for (std::size_t lane = 0; lane < LightArrays::kLanes; ++lane) lanes[lane] += f(l + lane);
  }
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

}  // namespace lobefit
