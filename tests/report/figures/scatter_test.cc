#include "lobefit/report/figures/scatter.h"

#include <algorithm>
#include <cmath>

#include "tests/report/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/report/figures/isotropic_lookup.h"

namespace lobefit {
namespace {

std::vector<ScatterPoint> RandomPoints(std::size_t count, int dimensions) {
  std::vector<ScatterPoint> points(count);
  std::uint64_t state = 7;
  for (ScatterPoint& point : points) {
    point = {0, 0, 0, 0};
    for (int d = 0; d < dimensions; ++d) {
      state = state * 6364136223846793005ULL + 1442695040888963407ULL;
      point[static_cast<std::size_t>(d)] = static_cast<float>(state >> 40U) / 16777216.0F;
    }
  }
  return points;
}

TEST(ScatterTree, FindsTheSameNeighboursAsLookingAtAll) {
  for (const int dimensions : {2, 3, 4}) {
    const std::vector<ScatterPoint> points = RandomPoints(2000, dimensions);
    const ScatterTree tree(points, dimensions);
    for (const ScatterPoint& at : RandomPoints(50, dimensions)) {
      std::vector<float> all;
      for (const ScatterPoint& point : points) {
        float sum = 0;
        for (std::size_t k = 0; k < 4; ++k) sum += (point[k] - at[k]) * (point[k] - at[k]);
        all.push_back(sum);
      }
      std::sort(all.begin(), all.end());
      std::array<ScatterTree::Neighbour, ScatterTree::kMost> found;
      ASSERT_EQ(tree.Nearest(at, 6, &found), 6);
      for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(found[k].distance2, all[k]);
    }
  }
}

TEST(ScatterTree, FewPointsAndEqualPoints) {
  std::array<ScatterTree::Neighbour, ScatterTree::kMost> found;
  EXPECT_EQ(ScatterTree({}, 2).Nearest({0, 0, 0, 0}, 4, &found), 0);
  EXPECT_EQ(ScatterTree(std::vector<ScatterPoint>(100, ScatterPoint{1, 2, 0, 0}), 2).Nearest({0, 0, 0, 0}, 4, &found),
            4);
}

TEST(ScatterField, SpeaksOnlyNearItsPoints) {
  std::vector<ScatterPoint> grid;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) grid.push_back({0.1F * static_cast<float>(i), 0.1F * static_cast<float>(j), 0, 0});
  }
  const ScatterField field(grid, 2, 0.01F);
  std::array<std::uint32_t, 4> indices;
  std::array<float, 4> weights;
  bool near = false;
  ASSERT_EQ(field.Find({0.45F, 0.45F, 0, 0}, &indices, &weights, &near), 4);
  EXPECT_TRUE(near);
  EXPECT_NEAR(weights[0] + weights[1] + weights[2] + weights[3], 1, 1e-5);
  field.Find({1.5F, 0.5F, 0, 0}, &indices, &weights, &near);
  EXPECT_FALSE(near);
}

TEST(IsotropicLookup, GivesTheValuesOfATableBack) {
  const Material material = test::MakeMaterial(3, true);
  const Measurement measurement = test::Measure(material, test::TablePairs(), 0, true);
  const IsotropicLookup lookup(measurement);
  const Reflectance reflectance(material.model, material.Values(), 3);
  std::vector<double> found(3), expected(3);
  double worst = 0;
  int known = 0;
  for (int k = 0; k < 200; ++k) {
    const Vec3 wi = test::AtDegrees(3 + 0.3 * k, 11.0 * k), wo = test::AtDegrees(62 - 0.25 * k, 77.0 * k);
    if (!lookup.Find(wi, wo, found.data())) continue;
    ++known;
    reflectance.Evaluate(wi, wo, expected.data());
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      worst = std::max(worst, std::fabs(std::log(found[i] / expected[i])));
    }
  }
  EXPECT_GE(known, 195);
  // Interpolation in a table of 45 x 45 x 18 cells.
  EXPECT_LT(worst, 0.25);
}

TEST(IsotropicLookup, ObeysReciprocityAndMirrorSymmetry) {
  const Material material = test::MakeMaterial(1, true);
  const IsotropicLookup lookup(test::Measure(material, test::TablePairs(), 0.1, true));
  const Vec3 wi = test::AtDegrees(40, 20), wo = test::AtDegrees(55, 170);
  double a = 0, b = 0, c = 0;
  ASSERT_TRUE(lookup.Find(wi, wo, &a) && lookup.Find(wo, wi, &b) &&
              lookup.Find({wi.x, -wi.y, wi.z}, {wo.x, -wo.y, wo.z}, &c));
  EXPECT_NEAR(a, b, 1e-5 * a);
  EXPECT_NEAR(a, c, 1e-5 * a);
}

// At the horizon, where light and viewer may stand opposite to each other, there is no half vector.
TEST(IsotropicLookup, KnowsNothingOfOppositeDirections) {
  const Material material = test::MakeMaterial(1, true);
  const IsotropicLookup lookup(test::Measure(material, test::TablePairs(), 0, true));
  double value = -7;
  for (const Vec3& w : {Vec3{1, 0, 0}, Vec3{0, -1, 0}}) {
    EXPECT_FALSE(lookup.Find(w, -w, &value));
    EXPECT_EQ(value, -7) << "nothing is written";
  }
}

}  // namespace
}  // namespace lobefit
