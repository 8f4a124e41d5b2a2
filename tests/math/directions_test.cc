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

// phi_d of the whole turn, folded by mirror symmetry and reciprocity, is what the faster formula gives.
TEST(FoldedHalfDifference, IsTheHalfDifferenceFolded) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> z(0.001, 1), turn(-kPi, kPi);
  for (int k = 0; k < 5000; ++k) {
    const Vec3 wi = FromSpherical(std::acos(z(random)), turn(random)),
               wo = FromSpherical(std::acos(z(random)), turn(random));
    const HalfDifference full = ToHalfDifference(wi, wo);
    for (const auto& [a, b] : {std::pair{wi, wo}, {wo, wi}, {Vec3{wi.x, -wi.y, wi.z}, Vec3{wo.x, -wo.y, wo.z}}}) {
      const HalfDifference folded = ToFoldedHalfDifference(a, b);
      ASSERT_NEAR(folded.theta_h, full.theta_h, 1e-13);
      ASSERT_NEAR(folded.theta_d, full.theta_d, 1e-13);
      ASSERT_EQ(folded.phi_h, 0);
      // The azimuth of a difference vector of length d is known to rounding over d.
      ASSERT_NEAR(folded.phi_d, std::fabs(std::remainder(full.phi_d, kPi)), 1e-14 / std::sin(full.theta_d));
    }
  }
}

TEST(FoldedHalfDifference, AlongTheNormalThereIsNoAzimuth) {
  const HalfDifference equal = ToFoldedHalfDifference({0, 0, 1}, {0, 0, 1});
  EXPECT_EQ(equal.theta_h, 0);
  EXPECT_EQ(equal.theta_d, 0);
  // Half vector along the normal: phi_h = 0 by choice, as in the other form.
  const Vec3 wi = FromSpherical(0.5, 0.3), wo = FromSpherical(0.5, 0.3 + kPi);
  EXPECT_NEAR(ToFoldedHalfDifference(wi, wo).theta_h, 0, 1e-15);
  EXPECT_NEAR(ToFoldedHalfDifference(wi, wo).theta_d, 0.5, 1e-15);
}

}  // namespace
}  // namespace lobefit
