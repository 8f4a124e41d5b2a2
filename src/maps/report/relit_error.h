// How well maps predict photographs.
#pragma once

#include <vector>

#include "lobefit/maps/relight.h"
#include "lobefit/maps/report/doubts.h"
#include "lobefit/maps/stack/stack.h"

namespace lobefit {

struct RelitLight {
  std::size_t light = 0;  // of the stack, from 0
  bool fitted = true;
  // 10 log10 of the square of the 99.9th percentile of all photographs over the mean squared difference, dB, over the
  // texels that have a normal.
  double psnr = kNan;
};

// Of each light, and what the fitted lights say of the stack (nothing where its lights are near). Reads the
// stack once, in bands.
struct Judgement {
  std::vector<RelitLight> lights;
  StackDoubts doubts;
};
Judgement JudgeLights(const Maps& maps, const Stack& stack, const std::vector<std::size_t>& left_out,
                      const Fallback& fallback);

// One photograph and the fit under its light, both as the light falls there, [texel channels + channel]; NaN outside.
struct RelitPair {
  std::vector<float> photograph, fit;
};
RelitPair Relit(const Maps& maps, const Stack& stack, std::size_t light, const Fallback& fallback);

}  // namespace lobefit
