// Evaluates an RGL `.bsdf` file at any pair of directions, as the renderers' loaders do.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "lobefit/io/rgl/tables.h"
#include "lobefit/io/rgl/warp.h"
#include "lobefit/math/vec.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

class RglBrdf {
 public:
  // The bytes need not outlive the constructor. Throws InputError.
  RglBrdf(const std::filesystem::path& path, std::string_view bytes);

  const Channels& channels() const { return channels_; }
  bool isotropic() const { return tables_.isotropic(); }

  // f_r in 1/sr of each channel (the loaders' value without its cosine); 0 where a direction is at or below the
  // horizon. wi is the light, wo the viewer: the table's direction. Between tabulated directions densities and values
  // are interpolated linearly.
  void Evaluate(const Vec3& wi, const Vec3& wo, double* values) const;

  // Whether the value stands between measured ones: the viewer lies within the tabulated polar angles, and the nodes
  // around the light are above the horizon. Elsewhere Evaluate continues the table, as renderers do, and divides by a
  // cosine that nothing was measured at: the result may be off by any factor.
  bool Covers(const Vec3& wi, const Vec3& wo) const;

 private:
  // The slices around a viewer, and the place of the light in each of their tables.
  struct Place {
    Vec3 wi, wo;  // in the part of the circle that the file stores
    Vec2 u, point;
    std::array<BilinearWarp::Part, 4> parts;
    std::array<std::size_t, 4> slices;
    std::size_t count = 0;
  };
  Place Find(const Vec3& wi, const Vec3& wo) const;
  // The light of a node of a slice's table.
  Vec3 LightOf(std::size_t slice, std::size_t column, std::size_t row) const;

  RglTables tables_;
  Channels channels_;
  int reduction_;
  std::vector<BilinearWarp> warps_;
  std::vector<float> light_z_;  // [slice][node]; 0 where light or viewer is at or below the horizon
};

}  // namespace lobefit
