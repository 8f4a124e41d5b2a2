#include "lobefit/io/rgl/warp.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace lobefit {
namespace {

const std::vector<float> kDensity = {0, 1, 3, 0, 2, 5, 1, 4, 0, 0, 7, 2};  // 4 columns, 3 rows

TEST(BilinearWarp, DensityIntegratesToOneAndIsProportionalToTheTable) {
  const BilinearWarp warp(kDensity.data(), 4, 3);
  double sum = 0, pdf = 0;
  constexpr int kN = 600;
  for (int y = 0; y < kN; ++y) {
    for (int x = 0; x < kN; ++x) {
      warp.Invert({(x + 0.5) / kN, (y + 0.5) / kN}, &pdf);
      sum += pdf / (kN * kN);
    }
  }
  EXPECT_NEAR(sum, 1, 1e-5);
  double at_one = 0, at_seven = 0;
  warp.Invert({1.0 / 3, 0}, &at_one);
  warp.Invert({2.0 / 3, 1}, &at_seven);
  EXPECT_NEAR(at_seven / at_one, 7, 1e-12);
}

TEST(BilinearWarp, SampleAndInvertAreInverse) {
  const BilinearWarp warp(kDensity.data(), 4, 3);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.001, 0.999);
  for (int i = 0; i < 2000; ++i) {
    const Vec2 u = {uniform(random), uniform(random)};
    double pdf_sample = 0, pdf_invert = 0;
    const Vec2 back = warp.Invert(warp.Sample(u, &pdf_sample), &pdf_invert);
    EXPECT_NEAR(back.x, u.x, 1e-4);
    EXPECT_NEAR(back.y, u.y, 1e-4);
    EXPECT_NEAR(pdf_sample / pdf_invert, 1, 1e-4);
  }
}

// The determinant of the warp is the inverse of the density: checked by differences.
TEST(BilinearWarp, DensityIsTheInverseOfTheStretch) {
  const BilinearWarp warp(kDensity.data(), 4, 3);
  constexpr double kStep = 1e-5;
  double pdf = 0, unused = 0;
  for (const Vec2& u : {Vec2{0.3, 0.2}, Vec2{0.7, 0.55}, Vec2{0.52, 0.81}}) {
    const Vec2 at = warp.Sample(u, &pdf);
    const Vec2 dx = warp.Sample({u.x + kStep, u.y}, &unused), dy = warp.Sample({u.x, u.y + kStep}, &unused);
    const double determinant = ((dx.x - at.x) * (dy.y - at.y) - (dx.y - at.y) * (dy.x - at.x)) / (kStep * kStep);
    EXPECT_NEAR(std::fabs(determinant) * pdf, 1, 1e-3);
  }
}

TEST(Bilinear, InterpolatesAndClamps) {
  EXPECT_DOUBLE_EQ(Bilinear(kDensity.data(), 4, 3, {0, 0}), 0);
  EXPECT_DOUBLE_EQ(Bilinear(kDensity.data(), 4, 3, {0.5, 0.25}), (1 + 3 + 5 + 1) / 4.0);
  EXPECT_DOUBLE_EQ(Bilinear(kDensity.data(), 4, 3, {2, 2}), 2);
}

}  // namespace
}  // namespace lobefit
