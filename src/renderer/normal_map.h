// A constant normal map: the nearest that renderers have to a tilted lobe.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lobefit/math/vec.h"

namespace lobefit {

// A PNG of 4 x 4 equal pixels with 16 bits a channel, (n + 1) / 2: steps of 0.002 degrees.
std::string NormalMapPng(const Vec3& normal);

// 8 bits, for glTF, whose readers keep no more: the pixel and the factor of x and y (glTF's `scale`) with which the
// normal comes out right to 0.01 degrees; of tilts above two degrees along an axis, to 0.4 % of the tilt.
struct ScaledNormal {
  std::string png;
  double scale = 1;
};
ScaledNormal ScaledNormalMapPng(const Vec3& normal);

// The normal of a constant map, x and y times `scale`, of unit length. Throws InputError that names `file`, also where
// the pixels differ.
Vec3 NormalOfPng(std::string_view png, double scale, const std::filesystem::path& file);

}  // namespace lobefit
