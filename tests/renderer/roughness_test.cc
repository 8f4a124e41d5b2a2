// Roughness maps against check values and formulas of the renderers' own documents, and each inverse.
#include "lobefit/renderer/roughness.h"

#include <cmath>

#include <gtest/gtest.h>

namespace lobefit {
namespace {

// r = 0.5 and 0.5 for the second number: the closed forms, and the published five digits.
TEST(RoughnessMaps, CheckValues) {
  const Widths principled = PrincipledWidths({0.5, 0.5});
  EXPECT_NEAR(principled.alpha_1, 0.25 / std::sqrt(0.55), 1e-12);
  EXPECT_NEAR(principled.alpha_2, 0.25 * std::sqrt(0.55), 1e-12);
  EXPECT_NEAR(principled.alpha_1, 0.33710, 5e-6);
  EXPECT_NEAR(principled.alpha_2, 0.18540, 5e-6);

  const Widths materialx = MaterialXWidths({0.5, 0.5});
  EXPECT_NEAR(materialx.alpha_1, 0.25 / std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(materialx.alpha_2, 0.25 * std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(materialx.alpha_1, 0.35355, 5e-6);
  EXPECT_NEAR(materialx.alpha_2, 0.17678, 5e-6);

  const Widths open_pbr = OpenPbrWidths({0.5, 0.5});
  EXPECT_NEAR(open_pbr.alpha_1, 0.25 * std::sqrt(1.6), 1e-12);
  EXPECT_NEAR(open_pbr.alpha_2, 0.125 * std::sqrt(1.6), 1e-12);
  EXPECT_NEAR(open_pbr.alpha_1, 0.31623, 5e-6);
  EXPECT_NEAR(open_pbr.alpha_2, 0.15811, 5e-6);

  const Widths gltf = GltfWidths({0.5, 0.5});
  EXPECT_NEAR(gltf.alpha_1, 0.4375, 1e-12);
  EXPECT_NEAR(gltf.alpha_2, 0.25, 1e-12);

  EXPECT_NEAR(PbrtRemappedAlpha(0.5), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(PbrtRemappedAlpha(0.5), 0.70711, 5e-6);
}

struct Map {
  const char* name;
  Widths (*widths)(const RoughnessPair&);
  RoughnessPair (*roughness)(const Widths&);
  double most_ratio;
};

class RoughnessInverse : public testing::TestWithParam<Map> {};

TEST_P(RoughnessInverse, GivesTheWidthsBack) {
  const Map& map = GetParam();
  for (const double alpha_1 : {0.01, 0.1, 0.35, 0.8, 1.0}) {
    for (const double ratio : {1.0, 1.5, 3.0, 9.0, 40.0}) {
      const Widths widths = {alpha_1, alpha_1 / ratio};
      if (ratio > map.most_ratio || widths.alpha_2 < 0.001) continue;
      const Widths back = map.widths(map.roughness(widths));
      EXPECT_NEAR(back.alpha_1, widths.alpha_1, 1e-12) << map.name << " " << alpha_1 << " ratio " << ratio;
      EXPECT_NEAR(back.alpha_2, widths.alpha_2, 1e-12) << map.name << " " << alpha_1 << " ratio " << ratio;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, RoughnessInverse,
                         testing::Values(Map{"principled", PrincipledWidths, PrincipledRoughness, 10},
                                         Map{"materialx", MaterialXWidths, MaterialXRoughness, 50},
                                         Map{"open_pbr", OpenPbrWidths, OpenPbrRoughness, 1e9},
                                         Map{"gltf", GltfWidths, GltfRoughness, 1e9}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(RoughnessMaps, LimitsOfTheTargets) {
  // Beyond a ratio of 10 Disney's principled BRDF has no more anisotropy, MaterialX' beyond 50.
  EXPECT_EQ(PrincipledRoughness({0.5, 0.01}).anisotropy, 1);
  EXPECT_EQ(MaterialXRoughness({0.9, 0.01}).anisotropy, 0.98);
  EXPECT_EQ(GltfRoughness({1, 1}).anisotropy, 0);
  EXPECT_NEAR(PbrtRemappedRoughness(PbrtRemappedAlpha(0.3)), 0.3, 1e-15);
}

}  // namespace
}  // namespace lobefit
