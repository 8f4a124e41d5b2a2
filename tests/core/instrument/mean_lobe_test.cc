// Cubature against the closed form, against itself with many nodes, and its limits.
#include "lobefit/core/instrument/mean_lobe.h"

#include <cmath>
#include <vector>

#include "tests/support/shapes.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/core/ellipsoid/off_center.h"

namespace lobefit {
namespace {

struct Means {
  double specular = 0, argument = 0, gradient[5] = {}, argument_gradient[5] = {};
};

Means MeansAt(const Vec3& wi, const Vec3& wo, const Lobe& lobe, const SlopeCoordinates& shape,
              const LobeMeanRule& rule) {
  Means m;
  MeanLobe({&wi.x, &wi.y, &wi.z, &wo.x, &wo.y, &wo.z, 1}, lobe, shape, rule,
           {&m.specular, &m.argument, m.gradient, m.argument_gradient});
  return m;
}

Lobe LobeOf(Ndf ndf, Masking masking) {
  Lobe lobe;
  lobe.ndf = ndf;
  lobe.masking = masking;
  return lobe;
}

TEST(MeanLobe, GgxHasTheClosedFormAndOthersDoNot) {
  EXPECT_TRUE(HasMeanInClosedForm(LobeOf(Ndf::kEllipsoid, Masking::kSmithHeight)));
  EXPECT_FALSE(HasMeanInClosedForm(LobeOf(Ndf::kEllipsoid, Masking::kSmithHeightDirection)));
  EXPECT_FALSE(HasMeanInClosedForm(LobeOf(Ndf::kBeckmann, Masking::kSmithSeparable)));
}

// The masking without a closed form that differs from one with it only where both directions are masked: at wi = the
// normal G1(wi) = 1 and both are equal, so that cubature meets the closed form.
TEST(MeanLobe, CubatureMeetsTheClosedForm) {
  ShapeGenerator random(21);
  for (int trial = 0; trial < 60; ++trial) {
    const double alpha = random.LogUniform(0.1, 0.4);
    const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid({alpha, 0.8 * alpha, 0, 0, 0.4});
    const Vec3 wi = {0, 0, 1};
    const double theta = random.Uniform(0, 4 * alpha), phi = random.Uniform(-3, 3);
    const Vec3 wo = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    Aperture aperture = {trial % 3 == 0 ? 0.3 * alpha : 0, 0.6 * alpha};
    if (trial % 3 == 0) continue;
    const Lobe closed = LobeOf(Ndf::kEllipsoid, Masking::kSmithSeparable);
    const Lobe cubature = LobeOf(Ndf::kEllipsoid, Masking::kSmithHeightDirection);
    const Means a = MeansAt(wi, wo, closed, shape, MakeLobeMeanRule(closed, aperture, 0.8 * alpha, 0.8));
    const Means b = MeansAt(wi, wo, cubature, shape, MakeLobeMeanRule(cubature, aperture, 0.8 * alpha, 0.8));
    EXPECT_NEAR(a.specular, b.specular, 1e-3 * a.specular) << trial;
    EXPECT_NEAR(a.argument, b.argument, 1e-6);
  }
}

// Beckmann: the rule's nodes against many more.
TEST(MeanLobe, RuleKeepsAThousandthOfThePeak) {
  ShapeGenerator random(22);
  const Lobe lobe = LobeOf(Ndf::kBeckmannOffCenter, Masking::kSmithSeparable);
  for (int trial = 0; trial < 60; ++trial) {
    const double width = random.Uniform(0.05, 1.9), alpha = 0.1;
    const double half_angle = 2 * alpha * width * 0.7;
    const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid({alpha, alpha, 0.05, 0.02, 0});
    Aperture aperture = {0, half_angle};
    if (trial % 2 == 0) aperture = {half_angle, 0.5 * half_angle};
    LobeMeanRule rule = MakeLobeMeanRule(lobe, aperture, alpha, 0.7);
    const double theta = random.Uniform(0.2, 0.6), phi = random.Uniform(-3, 3), off = random.Uniform(-0.2, 0.2);
    const Vec3 wi = {std::sin(theta), 0, std::cos(theta)};
    const Vec3 wo = Normalized(Vec3{-std::sin(theta) + off * std::cos(phi), off * std::sin(phi), std::cos(theta)});
    const Means coarse = MeansAt(wi, wo, lobe, shape, rule);
    const Means peak = MeansAt(wi, {-wi.x, wi.y, wi.z}, lobe, shape, rule);
    LobeMeanRule fine = rule;
    fine.points.clear();
    for (const DiscNode& node : DiscNodes(aperture, 16)) {
      for (const DiscPoint& point : DiscRings(16, 48)) {
        GgxMeanRule::Point to;
        SetDiscMultiples(point, DetectorShare(aperture) * std::sqrt(2 * node.tau), to.o);
        SetDiscMultiples(point, (1 - DetectorShare(aperture)) * std::sqrt(2 * node.tau), to.i);
        to.weight = node.weight * point.weight;
        fine.points.push_back(to);
      }
    }
    const Means exact = MeansAt(wi, wo, lobe, shape, fine);
    EXPECT_NEAR(coarse.specular, exact.specular, 3e-3 * peak.specular) << trial << " width " << width;
  }
}

TEST(MeanLobe, GradientsEqualDifferences) {
  const Lobe lobe = LobeOf(Ndf::kBeckmannOffCenter, Masking::kSmithSeparable);
  const SlopeCoordinates at = SlopeCoordinatesFromEllipsoid({0.2, 0.1, 0.05, 0.02, 0.3});
  const LobeMeanRule rule = MakeLobeMeanRule(lobe, {0, 0.04}, 0.1, 0.7);
  const Vec3 wi = Normalized(Vec3{0.4, 0.1, 0.8}), wo = Normalized(Vec3{-0.5, -0.1, 0.8});
  const Means m = MeansAt(wi, wo, lobe, at, rule);
  for (int j = 0; j < 5; ++j) {
    SlopeCoordinates low = at, high = at;
    low.v[j] -= 1e-6, high.v[j] += 1e-6;
    const Means a = MeansAt(wi, wo, lobe, low, rule), b = MeansAt(wi, wo, lobe, high, rule);
    EXPECT_NEAR(m.gradient[j], (b.specular - a.specular) / 2e-6, 1e-6 * m.specular);
    EXPECT_NEAR(m.argument_gradient[j], (b.argument - a.argument) / 2e-6, 1e-7);
  }
}

TEST(MeanLobe, RefusesLobesFarNarrowerThanTheDisc) {
  const Lobe lobe = LobeOf(Ndf::kBeckmann, Masking::kSmithSeparable);
  try {
    MakeLobeMeanRule(lobe, {0, DegreesToRadians(2)}, 0.005, 1);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "an aperture of 2 degrees (half angle) is 3.5 times as wide as a lobe of width 0.005 with the "
                 "distribution 'beckmann': allowed are 2 times; raise the lower bound of its width, or fit a GGX "
                 "distribution with Smith masking, whose mean has a closed form");
  }
}

}  // namespace
}  // namespace lobefit
