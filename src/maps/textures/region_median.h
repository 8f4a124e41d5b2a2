// What stands for numbers that are not determined: what the texels around have.
#pragma once

#include <cstddef>
#include <vector>

namespace lobefit {

// For each texel the median of the finite values of its block of 16 x 16 or, where they are fewer than 8, of the block
// of twice the side that holds it, and so on; NaN where nothing is finite at all. values[row width + column].
std::vector<float> RegionMedians(const std::vector<float>& values, std::size_t width, std::size_t height);

}  // namespace lobefit
