// What the pixels of a BRDF image stand for: a slice over half and difference angles, or the viewers of one incident
// direction.
#pragma once

#include <cstddef>
#include <string>

#include "lobefit/io/text/format.h"
#include "lobefit/math/vec.h"

namespace lobefit {

struct ExrMap {
  ExrAxes axes = ExrAxes::kSlice;
  ExrProjection projection = ExrProjection::kEquidistant;  // of a hemisphere
  ExrRows rows = ExrRows::kUp;                             // of a slice
  double phi_d = kPi / 2;                                  // of a slice, radians
  double theta_i = 0, phi_i = 0;                           // of a hemisphere, radians

  // The directions of the pixel's centre, row 0 on top; false where the pixel is no pair of directions above the
  // horizon (outside the disk, below the horizon). *measure is proportional to the pixel's measure in the space of
  // pairs. phi_h of a slice is 0.
  bool Directions(std::size_t column, std::size_t row, std::size_t width, std::size_t height, Vec3* wi, Vec3* wo,
                  double* measure) const;

  // Radians by which the pair lies off what an image with these axes holds: the angle of the difference vector to a
  // slice, of the light to that of a hemisphere.
  double DistanceTo(const Vec3& wi, const Vec3& wo) const;
};

}  // namespace lobefit
