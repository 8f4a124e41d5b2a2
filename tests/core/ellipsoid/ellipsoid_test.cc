#include "lobefit/core/ellipsoid/ellipsoid.h"

#include "tests/support/reference_table.h"
#include "tests/support/shapes.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

using EllipsoidJet = ceres::Jet<double, 8>;

TEST(EllipsoidTables, D) {
  const ReferenceTable table("ellipsoid_D");
  for (std::size_t row = 0; row < table.size(); ++row) {
    double gradient[5];
    const double value = EllipsoidD(EllipsoidOfRow(table, row), DirectionOfRow(table, row, "m"), gradient);
    const double cond = table(row, "cond");
    ExpectValue(value, table(row, "D"), cond, row);
    ExpectGradient(gradient, table, row, "dD_d", kEllipsoidNames, cond);
  }
}

TEST(EllipsoidTables, SigmaAndG1) {
  const ReferenceTable table("ellipsoid_G1");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Ellipsoid e = EllipsoidOfRow(table, row);
    const Vec3 u = DirectionOfRow(table, row, "u");
    const double cond = table(row, "cond_sigma");
    double gradient[5];
    ExpectValue(EllipsoidSigma(e, u, gradient), table(row, "sigma"), cond, row);
    ExpectGradient(gradient, table, row, "dsigma_d", kEllipsoidNames, cond);
    ExpectValue(EllipsoidG1Unclamped(e, u, gradient), table(row, "G1_unclamped"), cond, row);
    ExpectGradient(gradient, table, row, "dG1u_d", kEllipsoidNames, cond);
    bool clamped;
    ExpectValue(EllipsoidG1(e, u, gradient, &clamped), table(row, "G1"), cond, row);
    EXPECT_EQ(clamped, table(row, "clamped") == 1) << row;
    if (clamped) {
      for (const double d : gradient) EXPECT_EQ(d, 0.0);
    }
  }
}

// Parameters and direction as Jets with eight independent directions of derivation.
struct JetInputs {
  EllipsoidJet p[5];
  Vec3T<EllipsoidJet> w;
  JetInputs(const Ellipsoid& e, const Vec3& v)
      : p{EllipsoidJet(e.alpha_x, 0), EllipsoidJet(e.alpha_y, 1), EllipsoidJet(e.theta_x, 2),
          EllipsoidJet(e.theta_y, 3), EllipsoidJet(e.theta_z, 4)},
        w{EllipsoidJet(v.x, 5), EllipsoidJet(v.y, 6), EllipsoidJet(v.z, 7)} {}
};

TEST(Jets, AgreeWithTheAnalyticGradients) {
  ShapeGenerator random(1);
  for (int i = 0; i < 2000; ++i) {
    const Ellipsoid e = i % 2 == 0 ? random.Moderate() : random.Hostile();
    const Vec3 m = i % 3 == 0 ? random.Upper() : random.NearLobe(e), u = random.Sphere();
    double gradient[8];
    Vec3 dw;
    const double D = EllipsoidD(e, m, gradient, &dw);
    gradient[5] = dw.x, gradient[6] = dw.y, gradient[7] = dw.z;
    const JetInputs at_m(e, m);
    const EllipsoidJet jet_D = EllipsoidDFormula(at_m.p, at_m.w);
    EXPECT_NEAR(D, jet_D.a, 1e-10 * D);
    ExpectSameGradient(gradient, jet_D.v.data(), 5, 1e-10, D);
    ExpectSameGradient(gradient + 5, jet_D.v.data() + 5, 3, 1e-10);

    const double sigma = EllipsoidSigma(e, u, gradient, &dw);
    gradient[5] = dw.x, gradient[6] = dw.y, gradient[7] = dw.z;
    const JetInputs at_u(e, u);
    const EllipsoidJet jet_sigma = EllipsoidSigmaFormula(at_u.p, at_u.w);
    EXPECT_NEAR(sigma, jet_sigma.a, 1e-10 * sigma);
    ExpectSameGradient(gradient, jet_sigma.v.data(), 5, 1e-10, sigma);
    ExpectSameGradient(gradient + 5, jet_sigma.v.data() + 5, 3, 1e-10);
  }
}

TEST(Ellipsoid, ValueIsTheSameWithoutGradient) {
  ShapeGenerator random(2);
  for (int i = 0; i < 200; ++i) {
    const Ellipsoid e = random.Hostile();
    const Vec3 m = random.Upper();
    double gradient[5];
    EXPECT_EQ(EllipsoidD(e, m), EllipsoidD(e, m, gradient));
    EXPECT_EQ(EllipsoidSigma(e, m), EllipsoidSigma(e, m, gradient));
    EXPECT_EQ(EllipsoidG1(e, m), EllipsoidG1(e, m, gradient));
  }
  EXPECT_EQ(EllipsoidD({0.3, 0.2, 0.1, 0.1, 0}, Normalized(Vec3{0.1, 0.2, -0.01})), 0.0);
}

// Integrals of D over the normals that face both n and u, by the map m = A^T x / |A^T x| from the lune of the unit
// sphere where x.An > 0 and x.Au > 0 (its own Jacobian |A| / |A^T x|^3, not the function under test): smooth for any
// parameters.
template <class F>
void IntegrateOverLune(const Ellipsoid& e, const Vec3& u, const F& f) {
  static const QuadratureRule rule = GaussLegendre(24);
  const Mat3 r = EllipsoidRotation(e);
  const auto a_times = [&](const Vec3& w) {
    const Vec3 v = r * w;
    return Vec3{e.alpha_x * v.x, e.alpha_y * v.y, v.z};
  };
  const Vec3 a = Normalized(a_times(u)), b = Normalized(a_times({0, 0, 1}));
  const Vec3 cross = Cross(a, b);
  const double width = std::atan2(Norm(cross), -Dot(a, b));  // pi - the angle between a and b
  Vec3 e2 = Norm(cross) > 1e-12 ? Normalized(cross)
                                : Normalized(Cross(a, std::abs(a.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const Vec3 e1 = Cross(e2, a);
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double t = 0.5 * kPi * rule.nodes[i];
    for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
      const double half_width = 0.5 * width, s = half_width * (1 + rule.nodes[j]);
      const Vec3 x = (std::cos(t) * std::cos(s)) * e1 + std::sin(t) * e2 + (std::cos(t) * std::sin(s)) * a;
      const Vec3 v = Transposed(r) * Vec3{e.alpha_x * x.x, e.alpha_y * x.y, x.z};
      const double length = Norm(v);
      const Vec3 m = (1 / length) * v;
      const double dm = e.alpha_x * e.alpha_y / (length * length * length) * std::cos(t);
      f(m, 0.5 * kPi * half_width * rule.weights[i] * rule.weights[j] * dm);
    }
  }
}

TEST(EllipsoidLaws, NormalisationAndItsDerivative) {
  ShapeGenerator random(3);
  for (int i = 0; i < 100; ++i) {
    const Ellipsoid e = random.Hostile();
    double sum = 0, derivative[5] = {}, largest[5] = {};
    IntegrateOverLune(e, {0, 0, 1}, [&](const Vec3& m, double weight) {
      double gradient[5];
      sum += weight * m.z * EllipsoidD(e, m, gradient);
      for (int k = 0; k < 5; ++k) {
        derivative[k] += weight * m.z * gradient[k];
        largest[k] += weight * m.z * std::abs(gradient[k]);
      }
    });
    // 1e-11: D itself is known to 1e-12 for alpha = 1e-4 (its condition number in m).
    EXPECT_NEAR(sum, 1, 1e-11);
    for (int k = 0; k < 5; ++k) EXPECT_NEAR(derivative[k], 0, 1e-11 * largest[k] + 1e-14) << k;
  }
}

TEST(EllipsoidLaws, SigmaIsTheProjectedAreaAndItsGradientTheIntegralOfTheGradient) {
  ShapeGenerator random(4);
  for (int i = 0; i < 200; ++i) {
    const Ellipsoid e = random.Hostile();
    const Vec3 u = random.Sphere();
    if (u.z < -0.999) continue;  // the visible lune is a sliver whose normals m.u = 0 to rounding
    double sum = 0, dsum[5] = {}, largest = 0;
    IntegrateOverLune(e, u, [&](const Vec3& m, double weight) {
      double gradient[5];
      sum += weight * Dot(m, u) * EllipsoidD(e, m, gradient);
      for (int k = 0; k < 5; ++k) {
        dsum[k] += weight * Dot(m, u) * gradient[k];
        largest = std::fmax(largest, std::abs(weight * Dot(m, u) * gradient[k]));
      }
    });
    // 1e-10 of the largest term: D and m.u of normals near the edge of the lune have lost that many digits.
    double gradient[5];
    EXPECT_NEAR(EllipsoidSigma(e, u, gradient), sum, 1e-10 * sum);
    for (int k = 0; k < 5; ++k) EXPECT_NEAR(gradient[k], dsum[k], 1e-10 * largest);
  }
}

TEST(EllipsoidLaws, G1LiesBetweenZeroAndOne) {
  ShapeGenerator random(5);
  int clamped_count = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ellipsoid e = random.Hostile();
    const Vec3 u = random.Upper();
    bool clamped;
    const double g1 = EllipsoidG1(e, u, nullptr, &clamped);
    EXPECT_GT(g1, 0);
    EXPECT_LE(g1, 1);
    clamped_count += clamped ? 1 : 0;
  }
  EXPECT_GT(clamped_count, 200);
}

// The mesosurface identity: sigma(u) - sigma(-u) = int D (m.u) dm = u.(mean normal) / (mean normal . n), linear in u.
TEST(EllipsoidLaws, SignedProjectedAreaIsLinear) {
  ShapeGenerator random(6);
  for (int i = 0; i < 500; ++i) {
    const Ellipsoid e = random.Moderate();
    const auto odd = [&](const Vec3& u) { return EllipsoidSigma(e, u) - EllipsoidSigma(e, -u); };
    const Vec3 u = random.Sphere();
    EXPECT_NEAR(odd({0, 0, 1}), 1, 1e-14);
    EXPECT_NEAR(odd(u), u.x * odd({1, 0, 0}) + u.y * odd({0, 1, 0}) + u.z, 1e-12);
  }
}

}  // namespace
}  // namespace lobefit
