#include "lobefit/math/directions.h"

#include <random>

#include <gtest/gtest.h>

namespace lobefit {
namespace {

TEST(Directions, SphericalRoundTrip) {
  for (const double theta : {1e-9, 0.3, 1.2, kPi - 1e-7}) {
    for (const double phi : {-3.0, 0.0, 2.5}) {
      const Vec3 w = FromSpherical(theta, phi);
      EXPECT_NEAR(PolarAngle(w), theta, 1e-15 + 1e-15 * theta);
      EXPECT_NEAR(Azimuth(w), phi, 1e-14);
    }
  }
}

TEST(Directions, HalfDifferenceRoundTripAndMeaning) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 wi = FromSpherical(1.5 * unit(random), 6.2 * unit(random));
    const Vec3 wo = FromSpherical(1.5 * unit(random), 6.2 * unit(random));
    const HalfDifference angles = ToHalfDifference(wi, wo);
    EXPECT_NEAR(std::cos(angles.theta_d), Dot(wi, HalfVector(wi, wo)), 1e-14);
    Vec3 wi_again, wo_again;
    FromHalfDifference(angles, &wi_again, &wo_again);
    EXPECT_LT(Norm(wi_again - wi), 2e-14);
    EXPECT_LT(Norm(wo_again - wo), 2e-14);
    EXPECT_LT(Norm(Reflect(wi, HalfVector(wi, wo)) - wo), 1e-14);
  }
}

TEST(Directions, RotationsTurnTheDocumentedWay) {
  EXPECT_LT(Norm(RotateZ({1, 0, 0}, kPi / 2) - Vec3{0, 1, 0}), 1e-15);
  EXPECT_LT(Norm(RotateY({0, 0, 1}, kPi / 2) - Vec3{1, 0, 0}), 1e-15);
  EXPECT_LT(Norm(RotateX({0, 1, 0}, kPi / 2) - Vec3{0, 0, 1}), 1e-15);
}

}  // namespace
}  // namespace lobefit
