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

// The numbers of one texel that a prediction takes.
struct RelitTexel {
  bool hidden = false;            // it has no normal
  MapLobe lobe = MapLobe::kNone;  // kNone too where none is by evidence or its numbers are not known
  // Normal, slopes and widths as in engine/model.h; diffuse is the albedo, f0 the stack's, and the width that of
  // `fallback` where it is not determined.
  MapPoint point;
};
// All planes of the part "parameters", and the status, must be read.
RelitTexel RelitTexelAt(const Maps& maps, std::size_t texel, const Fallback& fallback);

// f_r cos_theta_i of one texel after another, as the engine defines it (engine/model.h).
class Relighting {
 public:
  // `maps` as for RelitTexelAt; they must outlive this.
  Relighting(const Maps& maps, const LightPaths& paths, bool schlick, const Fallback& fallback);
  // Moves lights and cameras, as many as before.
  void Move(const LightPaths& paths) { lights_.Set(paths, schlick_); }
  // values[channel stride + light]; NaN where the texel has no normal. Not for several threads at once.
  void Texel(std::size_t texel, double* values, std::size_t stride);

 private:
  const Maps& maps_;
  bool schlick_;
  LightArrays lights_;
  ShapeArrays shape_;
  Fallback fallback_;
};

}  // namespace lobefit
