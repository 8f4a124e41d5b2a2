#include "lobefit/measurement/checks/isotropy.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

TEST(SpreadOverAzimuths, TurnsEveryPairAsAWhole) {
  Samples samples;
  samples.values.resize(1);
  for (int k = 0; k < 200; ++k) {
    const double value = k;
    samples.Append(FromSpherical(0.4, 0.3), FromSpherical(0.9, 0.3 + 0.01 * k), &value, static_cast<std::uint32_t>(k));
  }
  const Samples spread = SpreadOverAzimuths(samples);
  double sum_x = 0, sum_y = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(spread.wi_z[i], samples.wi_z[i]);
    EXPECT_EQ(spread.wo_z[i], samples.wo_z[i]);
    EXPECT_NEAR(Dot(spread.wi(i), spread.wo(i)), Dot(samples.wi(i), samples.wo(i)), 1e-14);
    EXPECT_EQ(spread.values[0][i], samples.values[0][i]);
    sum_x += spread.wi_x[i];
    sum_y += spread.wi_y[i];
  }
  // The azimuths of wi, all the same before, cover the circle.
  EXPECT_LT(std::hypot(sum_x, sum_y) / 200, 0.02 * std::sin(0.4));
}

}  // namespace
}  // namespace lobefit
