#include "lobefit/maps/textures/region_median.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobefit {
namespace {

constexpr std::size_t kSmallestBlock = 16, kFewest = 8;

// Median of one block; NaN where it has fewer than `fewest` finite values.
float BlockMedian(const std::vector<float>& values, std::size_t width, std::size_t height, std::size_t x, std::size_t y,
                  std::size_t side, std::size_t fewest, std::vector<float>* finite) {
  finite->clear();
  for (std::size_t row = y; row < std::min(y + side, height); ++row) {
    for (std::size_t column = x; column < std::min(x + side, width); ++column) {
      const float value = values[row * width + column];
      if (std::isfinite(value)) finite->push_back(value);
    }
  }
  if (finite->size() < std::max<std::size_t>(fewest, 1)) return std::numeric_limits<float>::quiet_NaN();
  const auto middle = finite->begin() + static_cast<std::ptrdiff_t>(finite->size() / 2);
  std::nth_element(finite->begin(), middle, finite->end());
  return *middle;
}

}  // namespace

std::vector<float> RegionMedians(const std::vector<float>& values, std::size_t width, std::size_t height) {
  std::vector<float> medians(values.size(), std::numeric_limits<float>::quiet_NaN()), finite;
  // From small blocks to large ones; what a small one has said stays.
  for (std::size_t side = kSmallestBlock;; side *= 2) {
    const bool whole = side >= std::max(width, height);
    bool missing = false;
    for (std::size_t y = 0; y < height; y += side) {
      for (std::size_t x = 0; x < width; x += side) {
        bool open = false;
        for (std::size_t row = y; row < std::min(y + side, height) && !open; ++row) {
          for (std::size_t column = x; column < std::min(x + side, width) && !open; ++column) {
            open = std::isnan(medians[row * width + column]);
          }
        }
        if (!open) continue;
        const float median = BlockMedian(values, width, height, x, y, side, whole ? 1 : kFewest, &finite);
        missing = missing || std::isnan(median);
        for (std::size_t row = y; row < std::min(y + side, height); ++row) {
          for (std::size_t column = x; column < std::min(x + side, width); ++column) {
            float& value = medians[row * width + column];
            if (std::isnan(value)) value = median;
          }
        }
      }
    }
    if (whole || !missing) return medians;
  }
}

}  // namespace lobefit
