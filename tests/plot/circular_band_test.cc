// Coverage of discs and rings, computed near their edges only, against the formula at every pixel.
#include "lobefit/plot/circular_band.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace lobefit {
namespace {

struct BandCase {
  double inner, outer, cx, cy;
};

class CircularBandOf : public testing::TestWithParam<BandCase> {};

TEST_P(CircularBandOf, IsTheFormulaAtEveryPixel) {
  constexpr int kSize = 64;
  const BandCase& c = GetParam();
  const CircularBand band(c.inner, c.outer);
  for (int y = 0; y < kSize; ++y) {
    std::vector<int> found(kSize, 0);
    int last = -1;
    band.ForEach(c.cx, y + 0.5 - c.cy, 3, kSize - 2, [&](int x, std::uint8_t coverage) {
      ASSERT_GT(x, last) << "not in order, or twice";
      ASSERT_GT(coverage, 0);
      last = x;
      found[static_cast<std::size_t>(x)] = coverage;
    });
    for (int x = 0; x < kSize; ++x) {
      const double distance = std::hypot(x + 0.5 - c.cx, y + 0.5 - c.cy);
      const double covered = std::clamp(std::min(c.outer - distance, distance - c.inner) + 0.5, 0.0, 1.0);
      const long expected = x < 3 || x >= kSize - 2 ? 0 : std::lround(255 * covered);
      ASSERT_EQ(found[static_cast<std::size_t>(x)], expected) << x << ' ' << y;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bands, CircularBandOf,
                         testing::Values(BandCase{-1, 20, 31.3, 30.8},      // a disc
                                         BandCase{-1, 0.4, 12.5, 12.5},     // smaller than a pixel
                                         BandCase{-1, 90, 31, 31},          // larger than the picture
                                         BandCase{-1, 12, -4, 70},          // mostly outside
                                         BandCase{17.5, 18.5, 30.1, 33.7},  // a thin ring
                                         BandCase{5, 25, 32, 32},           // a thick one, edges on pixels
                                         BandCase{-0.3, 0.7, 20.2, 20.4},   // a ring without a hole
                                         BandCase{60, 61, 2, 2}));

}  // namespace
}  // namespace lobefit
