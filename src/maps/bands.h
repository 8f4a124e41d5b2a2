// Fitting rows of a stack on all threads.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "lobefit/maps/output/planes.h"
#include "lobefit/maps/recipe.h"
#include "lobefit/maps/shared_numbers.h"
#include "lobefit/maps/stack/reader.h"

namespace lobefit {

// Which maps a recipe makes of a stack.
MapKind KindOf(const MapRecipe& recipe, const Stack& stack);

// The lights that are fitted, and where they stand among the stack's.
struct FittedLights {
  std::vector<std::size_t> index;
  std::vector<Vec3> directions;  // of near lights those at the middle of the picture
};
FittedLights LightsWithout(const Stack& stack, const std::vector<std::size_t>& left_out);

// The values of one texel of a band under those lights: [channel lights + light].
void Gather(const StackBand& band, std::size_t texel, std::size_t channels, const FittedLights& lights,
            std::size_t all_lights, float* values);

// Rows that a band holds: 16 MB of values, at most 64.
std::size_t RowsOfBand(const Stack& stack);

// Fits the rows of `ranges` in bands; `done` gets each band, from any thread. Images are decoded by one thread at a
// time, each row once. Where texels are parted into clusters each is fitted twice: by itself, to see which it is of.
void FitBands(const Stack& stack, const MapRecipe& recipe, const FittedLights& lights, const SharedNumbers& shared,
              const std::vector<std::pair<std::size_t, std::size_t>>& ranges, int threads,
              const std::function<void(const MapRows&)>& done);

}  // namespace lobefit
