#include "lobefit/core/ellipsoid/ellipsoid_symmetry.h"

#include "tests/support/shapes.h"
#include <gtest/gtest.h>

#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// The same D at normals near the lobe and elsewhere. Tolerance: a rounding of an angle moves ln D by eps / alpha.
void ExpectSameDistribution(const Ellipsoid& a, const Ellipsoid& b, ShapeGenerator* random, double tolerance) {
  for (int i = 0; i < 4; ++i) {
    const Vec3 m = i < 2 ? random->NearLobe(a) : random->Upper();
    const double D = EllipsoidD(a, m);
    EXPECT_NEAR(EllipsoidD(b, m), D, tolerance * D);
  }
}

TEST(EllipsoidSymmetry, LeavesDUnchanged) {
  ShapeGenerator random(61);
  for (int i = 0; i < 500; ++i) {
    Ellipsoid e = random.Moderate();
    e.theta_x += random.Index(5) * kPi / 2;
    e.theta_y += random.Index(7) * kPi / 3;
    const double tolerance = 1e-11;
    ExpectSameDistribution(e, CanonicalEllipsoid(e), &random, tolerance);
    ExpectSameDistribution(e, FoldAngles(e), &random, tolerance);
    ExpectSameDistribution(e, SwapAxes(e), &random, tolerance);
    ExpectSameDistribution(e, PromoteAxis(e, 0), &random, tolerance);
    ExpectSameDistribution(e, PromoteAxis(e, 1), &random, tolerance);
    const auto same = [&](double tx, double ty, double tz) {
      ExpectSameDistribution(e, {e.alpha_x, e.alpha_y, tx, ty, tz}, &random, tolerance);
    };
    same(e.theta_x + kPi, e.theta_y, e.theta_z);
    same(-e.theta_x, e.theta_y + kPi, e.theta_z);
    same(-e.theta_x, -e.theta_y, e.theta_z + kPi);
    same(e.theta_x + kPi, kPi - e.theta_y, e.theta_z + kPi);
    const Ellipsoid no_y = {e.alpha_x, e.alpha_y, e.theta_x, 0, e.theta_z};
    ExpectSameDistribution(no_y, {e.alpha_y, e.alpha_x, 0, e.theta_x, e.theta_z + kPi / 2}, &random, tolerance);
    const Ellipsoid no_x = {e.alpha_x, e.alpha_y, 0, e.theta_y, e.theta_z};
    ExpectSameDistribution(no_x, {e.alpha_y, e.alpha_x, -e.theta_y, 0, e.theta_z + kPi / 2}, &random, tolerance);
  }
}

TEST(EllipsoidSymmetry, TheNearestFormOfAnEllipsoidIsItself) {
  ShapeGenerator random(66);
  for (int i = 0; i < 500; ++i) {
    const Ellipsoid e = random.Moderate();
    const Ellipsoid turned = {e.alpha_x, e.alpha_y, -e.theta_x, -e.theta_y, e.theta_z + kPi};
    for (Ellipsoid other : {e, turned, SwapAxes(e), SwapAxes(turned)}) {
      other.theta_z += 2 * kPi * static_cast<double>(random.Index(5) - 2);
      const Ellipsoid nearest = NearestEllipsoid(other, e);
      EXPECT_NEAR(nearest.alpha_x, e.alpha_x, 1e-15);
      EXPECT_NEAR(nearest.alpha_y, e.alpha_y, 1e-15);
      EXPECT_NEAR(nearest.theta_x, e.theta_x, 1e-13);
      EXPECT_NEAR(nearest.theta_y, e.theta_y, 1e-13);
      EXPECT_NEAR(nearest.theta_z, e.theta_z, 1e-13);
    }
    // Of anything else it is some form of that.
    const Ellipsoid else_where = random.Moderate();
    ExpectSameDistribution(else_where, NearestEllipsoid(else_where, e), &random, 1e-11);
  }
}

TEST(EllipsoidSymmetry, HostileShapes) {
  ShapeGenerator random(62);
  for (int i = 0; i < 1000; ++i) {
    const Ellipsoid e = random.Hostile();
    const double tolerance = 1e-13 / std::fmin(e.alpha_x, e.alpha_y);
    ExpectSameDistribution(e, CanonicalEllipsoid(e), &random, tolerance);
    ExpectSameDistribution(e, FoldAngles(e), &random, tolerance);
    ExpectSameDistribution(e, SwapAxes(e), &random, tolerance);
    ExpectSameDistribution(e, PromoteAxis(e, random.Index(2)), &random, tolerance);
  }
}

TEST(CanonicalEllipsoid, Ranges) {
  ShapeGenerator random(63);
  for (int i = 0; i < 2000; ++i) {
    Ellipsoid e = random.Hostile();
    e.alpha_x *= random.LogUniform(1e-1, 1e2);
    e.theta_x += random.Uniform(-7, 7);
    e.theta_y += random.Uniform(-7, 7);
    const Ellipsoid c = CanonicalEllipsoid(e);
    EXPECT_LE(c.alpha_y, c.alpha_x);
    EXPECT_LE(c.alpha_x, 1);
    EXPECT_GE(EllipsoidRotation(c).row[2].z, 0);
    EXPECT_GT(c.theta_z, -kPi / 2);
    EXPECT_LE(c.theta_z, kPi / 2);
    const Ellipsoid again = CanonicalEllipsoid(c);
    EXPECT_NEAR(again.theta_x, c.theta_x, 1e-14);
    EXPECT_NEAR(again.theta_y, c.theta_y, 1e-14);
    EXPECT_NEAR(again.theta_z, c.theta_z, 1e-14);
    const Ellipsoid f = FoldAngles(e);
    EXPECT_LE(std::abs(f.theta_x), kPi / 2);
    EXPECT_LE(std::abs(f.theta_y), kPi / 2);
    EXPECT_LE(std::abs(f.theta_z), kPi / 2);
  }
}

// Two routes to the canonical form: through the rotation's rows, and through slope space and back.
TEST(CanonicalEllipsoid, AgreesWithTheRouteThroughSlopeSpace) {
  ShapeGenerator random(64);
  for (int i = 0; i < 1000; ++i) {
    const Ellipsoid e = random.Moderate();
    const Ellipsoid a = CanonicalEllipsoid(e), b = EllipsoidFromSlopeCoordinates(SlopeCoordinatesFromEllipsoid(e));
    const double tolerance = 1e-13 / std::fmin(1 - a.alpha_y / a.alpha_x, 1 - a.alpha_x);
    EXPECT_NEAR(a.alpha_x, b.alpha_x, 1e-13);
    EXPECT_NEAR(a.alpha_y, b.alpha_y, 1e-13);
    EXPECT_NEAR(a.theta_x, b.theta_x, tolerance);
    EXPECT_NEAR(a.theta_y, b.theta_y, tolerance);
    EXPECT_NEAR(std::remainder(a.theta_z - b.theta_z, kPi), 0, tolerance);
  }
}

TEST(EllipsoidSymmetry, MirrorAndTurn) {
  ShapeGenerator random(65);
  for (int i = 0; i < 200; ++i) {
    const Ellipsoid e = random.Moderate();
    const Vec3 m = random.NearLobe(e);
    const double D = EllipsoidD(e, m), angle = random.Uniform(-kPi, kPi);
    EXPECT_NEAR(EllipsoidD(MirrorY(e), {m.x, -m.y, m.z}), D, 1e-11 * D);
    EXPECT_NEAR(EllipsoidD(TurnAboutNormal(e, angle), RotateZ(m, angle)), D, 1e-11 * D);
  }
}

TEST(EllipsoidPeak, IsTheMaximum) {
  ShapeGenerator random(66);
  for (int i = 0; i < 300; ++i) {
    Ellipsoid e = random.Moderate();
    e.alpha_x *= random.LogUniform(1, 10);
    double D_max;
    const Vec3 peak = EllipsoidPeak(e, &D_max);
    EXPECT_NEAR(EllipsoidD(e, peak), D_max, 1e-12 * D_max);
    for (int k = 0; k < 10; ++k) {
      const Vec3 near = Normalized(peak + 0.01 * random.Sphere());
      EXPECT_LE(EllipsoidD(e, near), D_max * (1 + 1e-14));
      EXPECT_LE(EllipsoidD(e, random.Upper()), D_max * (1 + 1e-14));
    }
  }
}

TEST(FlatDirections, AreNullVectorsOfTheGradient) {
  ShapeGenerator random(67);
  const double a = 0.3, b = 0.6, tx = 0.4, ty = -0.3, tz = 1.2;
  const std::vector<std::pair<Ellipsoid, std::size_t>> cases = {
      {{a, b, tx, ty, tz}, 0}, {{a, a, tx, ty, tz}, 1},      {{a, 1, tx, ty, tz}, 1}, {{1, a, tx, ty, tz}, 1},
      {{1, 1, tx, ty, tz}, 3}, {{a, b, tx, kPi / 2, tz}, 1}, {{1, a, 0, ty, tz}, 1},  {{a, b, tx, -kPi / 2, tz}, 1}};
  for (const auto& [e, count] : cases) {
    const auto flat = FlatDirections(e);
    EXPECT_EQ(flat.size(), count);
    for (int i = 0; i < 20; ++i) {
      double gradient[5];
      const Vec3 m = random.Upper();
      const double D = EllipsoidD(e, m, gradient);
      for (const auto& direction : flat) {
        double along = 0, norm = 0;
        for (std::size_t k = 0; k < 5; ++k) {
          along += direction[k] * gradient[k];
          norm += direction[k] * direction[k];
        }
        EXPECT_NEAR(norm, 1, 1e-14);
        EXPECT_NEAR(along, 0, 1e-13 * D);
      }
    }
  }
}

}  // namespace
}  // namespace lobefit
