#include "lobefit/core/instrument/aperture.h"

#include <cmath>

#include "tests/support/shapes.h"
#include <gtest/gtest.h>

namespace lobefit {
namespace {

TEST(Aperture, SharesAndWidthsOfDiscs) {
  EXPECT_NEAR(DiscTau(0.3), 1 - std::cos(0.3), 1e-16);
  EXPECT_NEAR(DiscTau(1e-9), 5e-19, 1e-33);
  EXPECT_EQ(DetectorShare({0, 0.02}), 1);
  EXPECT_EQ(DetectorShare({0.02, 0}), 0);
  EXPECT_NEAR(DetectorShare({0.02, 0.02}), 0.5, 1e-15);
  EXPECT_FALSE(Aperture{}.any());
  EXPECT_NEAR(RelativeDiscWidth(0.04, 0.1, 0.5), 0.4, 1e-15);
}

TEST(Aperture, NodesFollowTheSmallerDisc) {
  EXPECT_EQ(DiscNodeCount({0, 0.1}, 0.001, 0.2), 1);
  EXPECT_EQ(DiscNodeCount({0.1, 0}, 0.001, 0.2), 1);
  EXPECT_EQ(DiscNodeCount({0.02, 0.1}, 0.1, 1), 3);   // ceil(2 + 0.24)
  EXPECT_EQ(DiscNodeCount({0.02, 0.1}, 0.01, 1), 5);  // ceil(2 + 2.4)
  EXPECT_EQ(DiscNodeCount({0.02, 0.1}, 1e-6, 1), 40);
}

// Chebyshev's rule of the second kind: moments of the semicircle about tau_s + tau_d with radius r are r^2 / 4 and r^4
// / 8.
TEST(Aperture, NodesHaveTheMomentsOfTheSemicircle) {
  const Aperture aperture = {0.03, 0.05};
  const double s = DiscTau(0.03), d = DiscTau(0.05), r = 2 * std::sqrt(s * d);
  double moments[5] = {};
  for (const DiscNode& node : DiscNodes(aperture, 4)) {
    for (int k = 0; k < 5; ++k) moments[k] += node.weight * std::pow(node.tau - s - d, k);
  }
  EXPECT_NEAR(moments[0], 1, 1e-14);
  EXPECT_NEAR(moments[1], 0, 1e-14 * r);
  EXPECT_NEAR(moments[2], r * r / 4, 1e-14 * r * r);
  EXPECT_NEAR(moments[4], r * r * r * r / 8, 1e-14 * r * r * r * r);
  const std::vector<DiscNode> one = DiscNodes({0, 0.05}, 7);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].tau, d);
  EXPECT_EQ(one[0].weight, 1);
}

double DiscMoment(const std::vector<DiscPoint>& points, int p, int q) {
  double sum = 0;
  for (const DiscPoint& point : points) sum += point.weight * std::pow(point.p, p) * std::pow(point.q, q);
  return sum;
}

// Means over the unit disc: p^2: 1/4, p^4: 1/8, p^2 q^2: 1/24, p^6: 5/64.
TEST(Aperture, PointsHaveTheMomentsOfTheDisc) {
  for (const std::vector<DiscPoint>& points : {SevenDiscPoints(), DiscRings(4, 12)}) {
    EXPECT_NEAR(DiscMoment(points, 0, 0), 1, 1e-15);
    EXPECT_NEAR(DiscMoment(points, 1, 0), 0, 1e-15);
    EXPECT_NEAR(DiscMoment(points, 2, 0), 0.25, 1e-15);
    EXPECT_NEAR(DiscMoment(points, 0, 2), 0.25, 1e-15);
    EXPECT_NEAR(DiscMoment(points, 4, 0), 0.125, 1e-15);
    EXPECT_NEAR(DiscMoment(points, 2, 2), 1.0 / 24, 1e-15);
    EXPECT_NEAR(DiscMoment(points, 3, 2), 0, 1e-15);
  }
  EXPECT_NEAR(DiscMoment(DiscRings(4, 12), 6, 0), 5.0 / 64, 1e-15);
}

// A point of the disc's edge stands at the half angle; the solid angle grows with the square of the radius.
TEST(Aperture, MultiplesKeepAnglesAndUnitLength) {
  const DirectionPair pair = {Normalized(Vec3{0.3, 0.1, 0.9}), Normalized(Vec3{-0.5, 0.2, 0.7})};
  const Vec3 e3 = FrameOf(pair).e3;
  for (const double radius : {0.3, 1.0}) {
    for (const double phi : {0.0, 0.7, 2.5}) {
      double by[3];
      SetDiscMultiples({radius * std::cos(phi), radius * std::sin(phi), 1}, std::sqrt(2 * DiscTau(0.2)), by);
      const Vec3 moved = by[0] * pair.wo + by[1] * Cross(e3, pair.wo) + by[2] * e3;
      EXPECT_NEAR(Norm(moved), 1, 1e-15);
      EXPECT_NEAR(1 - Dot(moved, pair.wo), radius * radius * DiscTau(0.2), 1e-15);
    }
  }
}

TEST(Aperture, FrameIsOrthonormalAlsoForEqualDirections) {
  ShapeGenerator random(3);
  for (int k = 0; k < 400; ++k) {
    const Vec3 wi = random.Upper();
    const Vec3 wo = k % 3 == 0 ? wi : k % 3 == 1 ? Normalized(wi + Vec3{1e-7, -1e-8, 0}) : random.Upper();
    const PairFrame f = FrameOf({wi, wo});
    EXPECT_NEAR(Norm(f.h), 1, 1e-15);
    EXPECT_NEAR(Norm(f.e2), 1, 1e-15);
    EXPECT_NEAR(Norm(f.e3), 1, 1e-14);
    EXPECT_NEAR(Dot(f.h, f.e2), 0, 1e-15);
    EXPECT_NEAR(f.h2, 1 + Dot(wi, wo), 1e-14);
    // Both directions lie in the plane of h and e2; where they nearly agree, to what is left of their difference.
    const double apart = Norm(wi - wo);
    EXPECT_NEAR(Dot(f.e3, wi), 0, apart < 1e-6 ? apart + 1e-15 : 1e-15 / apart + 1e-14);
  }
}

}  // namespace
}  // namespace lobefit
