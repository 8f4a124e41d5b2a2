#include "lobefit/core/sel/sel_bound.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "lobefit/core/sel/sel.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/rotation.h"

namespace lobefit {
namespace {

class SelBoundTest : public testing::Test {
 protected:
  double Uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(engine_); }
  double LogUniform(double a, double b) { return std::exp(Uniform(std::log(a), std::log(b))); }
  Vec3 Gauss() {
    std::normal_distribution<double> gauss;
    return {gauss(engine_), gauss(engine_), gauss(engine_)};
  }
  // The lobe of one trial: alphas down to 1e-4, equal now and then.
  void NewLobe() {
    ax_ = LogUniform(1e-4, 1);
    ay_ = Uniform(0, 1) < 0.15 ? ax_ : LogUniform(1e-4, 1);
    rotation_ = Gauss();
    to_world_ = Transposed(RotationMatrix(rotation_));
  }
  // A world direction, most often near the lobe.
  Vec3 NearLobe() {
    if (Uniform(0, 1) < 0.4) return Normalized(Gauss());
    const double f = LogUniform(0.1, 30);
    const Vec3 g = Gauss();
    return to_world_ * Normalized(Vec3{f * ax_ * g.x, f * ay_ * g.y, 1});
  }
  double At(const Vec3& w) const { return SelLobe(ax_, ay_, RotationMatrix(rotation_) * w); }

  std::mt19937_64 engine_{21};
  double ax_ = 1, ay_ = 1;
  Vec3 rotation_ = {0, 0, 0};
  Mat3 to_world_ = RotationMatrix({0, 0, 0});
};

TEST_F(SelBoundTest, ConeIsNeverBelowAndTight) {
  double worst = 1;
  for (int trial = 0; trial < 1500; ++trial) {
    NewLobe();
    const Vec3 axis = NearLobe();
    const double half_angle = trial % 10 == 0 ? 0.0 : std::fmin(LogUniform(1e-5, 4), 3.3);
    const SelBound result = SelBoundOverCone(ax_, ay_, rotation_, axis, half_angle);
    EXPECT_LE(result.bound, 1);
    // Where K comes near the bound lies in the cone.
    EXPECT_LE(std::atan2(Norm(Cross(axis, result.direction)), Dot(axis, result.direction)), half_angle + 1e-12);
    EXPECT_LE(result.bound, At(result.direction) * (1 + 1.001 * kSelBoundTolerance));
    worst = std::fmax(worst, result.bound / At(result.direction));
    const Vec3 e1 = Normalized(Cross(axis, std::fabs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})),
               e2 = Cross(axis, e1);
    const double reach = std::fmin(half_angle, kPi);
    for (int i = 0; i < 1500; ++i) {
      // Half of the samples on the rim, where the maximum is.
      const double polar = i % 2 == 0 ? reach : reach * std::sqrt(Uniform(0, 1)), phi = Uniform(0, 2 * kPi);
      const Vec3 w = std::cos(polar) * axis + std::sin(polar) * (std::cos(phi) * e1 + std::sin(phi) * e2);
      ASSERT_LE(At(w), result.bound * (1 + 1e-11)) << "trial " << trial;
    }
  }
  RecordProperty("largest_bound_over_value", std::to_string(worst));
  EXPECT_LE(worst, 1 + 1.001 * kSelBoundTolerance);
}

TEST_F(SelBoundTest, BoxIsNeverBelowAndTight) {
  double worst = 1;
  int ones = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    NewLobe();
    const Vec3 center = LogUniform(0.1, 10) * NearLobe();
    const double size = LogUniform(1e-4, 3);
    Vec3 lower = center, upper = center;
    for (double Vec3::*c : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const double half = trial % 7 == 0 ? 0.0 : size * Uniform(0, 1);  // some boxes are points
      lower.*c -= half;
      upper.*c += half;
    }
    const SelBound result = SelBoundOverBox(ax_, ay_, rotation_, lower, upper);
    ones += result.bound == 1 ? 1 : 0;
    EXPECT_LE(result.bound, At(result.direction) * (1 + 1.001 * kSelBoundTolerance));
    worst = std::fmax(worst, result.bound / At(result.direction));
    for (int i = 0; i < 1500; ++i) {
      // Points in the box, many of them on its edges.
      Vec3 p;
      for (double Vec3::*c : {&Vec3::x, &Vec3::y, &Vec3::z}) {
        double t = Uniform(-0.5, 1.5);
        if (i % 3 == 0) t = Uniform(0, 1);
        p.*c = lower.*c + std::clamp(t, 0.0, 1.0) * (upper.*c - lower.*c);
      }
      ASSERT_LE(At(Normalized(p)), result.bound * (1 + 1e-11)) << "trial " << trial;
    }
  }
  RecordProperty("largest_bound_over_value", std::to_string(worst));
  EXPECT_LE(worst, 1 + 1.001 * kSelBoundTolerance);
  EXPECT_GT(ones, 50);
  EXPECT_LT(ones, 1000);
}

TEST_F(SelBoundTest, DirectionOfTheBoxLiesInTheBox) {
  for (int trial = 0; trial < 300; ++trial) {
    NewLobe();
    const Vec3 lower = Gauss();
    const Vec3 upper = lower + Vec3{Uniform(0.01, 1), Uniform(0.01, 1), Uniform(0.01, 1)};
    const Vec3 d = SelBoundOverBox(ax_, ay_, rotation_, lower, upper).direction;
    if (lower.x <= 0 && upper.x >= 0 && lower.y <= 0 && upper.y >= 0 && lower.z <= 0 && upper.z >= 0) continue;
    double enter = 0, leave = 1e300;
    for (double Vec3::*c : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const double a = lower.*c / (d.*c), b = upper.*c / (d.*c);
      enter = std::fmax(enter, std::fmin(a, b));
      leave = std::fmin(leave, std::fmax(a, b));
    }
    EXPECT_LE(enter, leave * (1 + 1e-9) + 1e-9);
  }
}

TEST_F(SelBoundTest, ToleranceIsMet) {
  for (int trial = 0; trial < 200; ++trial) {
    NewLobe();
    const Vec3 axis = NearLobe();
    const double half_angle = LogUniform(1e-3, 1);
    const SelBound coarse = SelBoundOverCone(ax_, ay_, rotation_, axis, half_angle, 0.1);
    const SelBound fine = SelBoundOverCone(ax_, ay_, rotation_, axis, half_angle, 1e-7);
    EXPECT_LE(fine.bound, At(fine.direction) * (1 + 1.1e-7));
    EXPECT_LE(fine.bound, coarse.bound * (1 + 1e-7));
    EXPECT_LE(coarse.bound, 1.1001 * fine.bound);
  }
}

TEST_F(SelBoundTest, KnownCases) {
  // A cone about the axis of a round lobe, too narrow to hold... the axis is in it: 1. Turned away: Ssl at the nearest
  // angle.
  EXPECT_EQ(SelBoundOverCone(0.2, 0.2, {0, 0, 0}, {0, 0, 1}, 0.1).bound, 1);
  const double nearest = Ssl(0.2, 0.5);
  const double bound = SelBoundOverCone(0.2, 0.2, {0, 0, 0}, FromSpherical(0.8, 1), 0.3, 1e-9).bound;
  EXPECT_NEAR(bound, nearest, 2e-9 * nearest);
  EXPECT_GE(bound, nearest * (1 - 1e-14));
  EXPECT_EQ(SelBoundOverCone(0.2, 0.4, {0, 0, 0}, {0, 0, -1}, 4).bound, 1);
  // The cap around the opposite direction of a narrow lobe: the wide plane's rim is brighter than the pole.
  EXPECT_GT(SelBoundOverCone(0.2, 0.4, {0, 0, 0}, {0, 0, -1}, 1).bound, SelLobe(0.2, 0.4, {0, 0, -1}));
  // A box straight above, one beside, one around.
  EXPECT_EQ(SelBoundOverBox(0.1, 0.2, {0, 0, 0}, {-1, -1, 1}, {1, 1, 2}).bound, 1);
  EXPECT_EQ(SelBoundOverBox(0.1, 0.2, {0, 0, 0}, {-1, -1, -1}, {1, 1, 2}).bound, 1);
  const double side = SelLobe(0.1, 0.2, Normalized(Vec3{1, 0, 2}));
  const double box = SelBoundOverBox(0.1, 0.2, {0, 0, 0}, {1, -1, 1}, {3, 1, 2}, 1e-9).bound;
  EXPECT_GE(box, side * (1 - 1e-14));
}

}  // namespace
}  // namespace lobefit
