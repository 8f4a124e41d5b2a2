// One width of the lobe for the whole image.
#pragma once

#include "lobefit/maps/bands.h"

namespace lobefit {

struct SharedWidth {
  double log_alpha = kNan, error = kNan;  // NaN: not shared
  std::size_t texels = 0;                 // that spoke
};

// The ln alpha of greatest likelihood, all else of a texel free and its level of noise profiled, over at most 4096
// texels on a grid: Newton's method from the median of the texels' own widths. Error: sandwich with texels as clusters.
// NaN where no texel has a lobe. Reads the stack once.
SharedWidth EstimateSharedWidth(const Stack& stack, const MapRecipe& recipe, const FittedLights& lights, int threads);

}  // namespace lobefit
