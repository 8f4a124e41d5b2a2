#include "lobefit/renderer/metal_base.h"

#include <gtest/gtest.h>

namespace lobefit {
namespace {

double Metal(const MetalBase& mixed, double base, double dielectric) {
  return dielectric * (1 - mixed.metalness) + base * mixed.metalness;
}

TEST(MetalBase, HasTheMeanReflectanceAndAlbedo) {
  for (const double f0 : {0.041, 0.1, 0.5, 0.95}) {
    for (const double diffuse : {0.0, 0.02, 0.4}) {
      const Spectrum reflectance = {f0, f0, f0}, albedo = {diffuse, diffuse, diffuse};
      const MetalBase mixed = MetalBaseOf(reflectance, albedo, kDefaultDielectric);
      ASSERT_GE(mixed.metalness, 0);
      ASSERT_LE(mixed.metalness, 1);
      for (const double base : mixed.base) {
        ASSERT_LE(base, 1);
        // Where one of them is at its limit the diffuse part gives way.
        if (base > 1 - 1e-9 || mixed.metalness < 0.02) continue;
        EXPECT_NEAR(Metal(mixed, base, kDefaultDielectric), f0, 1e-9) << f0 << ' ' << diffuse;
        EXPECT_NEAR(base * (1 - mixed.metalness) * (1 - kDefaultDielectric), diffuse, 1e-9) << f0 << ' ' << diffuse;
      }
    }
  }
}

// What was measured in an unknown scale may exceed 1; the search that was here before never ended.
TEST(MetalBase, AReflectanceAboveOneEnds) {
  const MetalBase mixed = MetalBaseOf({3.4, 2.2, 1.1}, {0.1, 0.1, 0.1}, kDefaultDielectric);
  EXPECT_GE(mixed.metalness, 0);
  EXPECT_LE(mixed.metalness, 1);
  for (const double base : mixed.base) EXPECT_LE(base, 1);
}

}  // namespace
}  // namespace lobefit
