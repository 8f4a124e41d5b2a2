#include "lobefit/math/rotation.h"

#include <random>

#include <gtest/gtest.h>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

double MaxDifference(const Mat3& a, const Mat3& b) {
  double worst = 0;
  for (int i = 0; i < 3; ++i) worst = std::fmax(worst, Norm(a.row[i] - b.row[i]));
  return worst;
}

TEST(Rotation, AgreesWithTheAxisRotations) {
  const Vec3 w = Normalized(Vec3{0.3, -0.5, 0.7});
  for (const double angle : {-4.0, -1e-9, 1e-200, 0.2, 3.1}) {
    EXPECT_LT(Norm(RotationMatrix({angle, 0, 0}) * w - RotateX(w, angle)), 4e-16);
    EXPECT_LT(Norm(RotationMatrix({0, angle, 0}) * w - RotateY(w, angle)), 4e-16);
    EXPECT_LT(Norm(RotationMatrix({0, 0, angle}) * w - RotateZ(w, angle)), 4e-16);
  }
}

TEST(Rotation, IsOrthogonalAndLeavesItsAxis) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> gauss;
  const Mat3 identity = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  for (int i = 0; i < 200; ++i) {
    const double scale = std::pow(10.0, -0.05 * i);
    const Vec3 r = {scale * gauss(random), scale * gauss(random), scale * gauss(random)};
    const Mat3 q = RotationMatrix(r);
    EXPECT_LT(MaxDifference(q * Transposed(q), identity), 2e-15);
    EXPECT_LT(Norm(q * r - r), 2e-15 * Norm(r));
    EXPECT_LT(Norm(RotationLeftJacobian(r) * r - r), 2e-15 * Norm(r));
  }
}

TEST(Rotation, LeftJacobianIsTheDerivative) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> gauss;
  for (int i = 0; i < 100; ++i) {
    const double scale = i % 4 == 0 ? 1e-5 : 1.0;
    const Vec3 r = {scale * gauss(random), scale * gauss(random), scale * gauss(random)};
    const Vec3 d = {gauss(random), gauss(random), gauss(random)};
    const Vec3 w = {gauss(random), gauss(random), gauss(random)};
    const double h = 1e-5;
    const Vec3 difference = (0.5 / h) * (RotationMatrix(r + h * d) * w - RotationMatrix(r - h * d) * w);
    const Vec3 derivative = Cross(RotationLeftJacobian(r) * d, RotationMatrix(r) * w);
    EXPECT_LT(Norm(difference - derivative), 1e-8);
  }
}

}  // namespace
}  // namespace lobefit
