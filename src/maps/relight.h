// Pictures from maps: what the fit predicts under lights of one's choice.
#pragma once

#include <vector>

#include "lobefit/maps/output/exr.h"

namespace lobefit {

// What stands for numbers that are not determined; NaN: the lobe is left out where its width or f0 is.
struct Fallback {
  double alpha = kNan;
  double f0[kMostChannels] = {kNan, kNan, kNan};
};
// Medians of the determined ones.
Fallback MedianFallback(const Maps& maps);

// f_r cos_theta_i of one texel after another under distant lights, as the engine defines it (engine/model.h).
class Relighting {
 public:
  // All planes of the part "parameters" must be read. `maps` must outlive this.
  Relighting(const Maps& maps, const std::vector<Vec3>& lights, bool schlick, const Fallback& fallback);
  // values[channel stride + light]; NaN where the texel has no normal. Not for several threads at once.
  void Texel(std::size_t texel, double* values, std::size_t stride);

 private:
  const Maps& maps_;
  LightArrays lights_;
  ShapeArrays shape_;
  Fallback fallback_;
  std::size_t normal_, diffuse_, f0_, alpha_;
};

}  // namespace lobefit
