// Evaluates an RGL `.bsdf` file at any pair of directions, as the renderers' loaders do.
#pragma once

#include <filesystem>
#include <string_view>

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

 private:
  RglTables tables_;
  Channels channels_;
  int reduction_;
  std::vector<BilinearWarp> warps_;
};

}  // namespace lobefit
