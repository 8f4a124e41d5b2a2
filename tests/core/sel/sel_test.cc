#include "lobefit/core/sel/sel.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/reference_table.h"
#include "tests/support/table_check.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "lobefit/core/sel/sel_cosine.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"
#include "lobefit/math/rotation.h"

namespace lobefit {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

class Random {
 public:
  explicit Random(int seed) : engine_(seed) {}
  double Uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(engine_); }
  double LogUniform(double a, double b) { return std::exp(Uniform(std::log(a), std::log(b))); }
  double Gauss() { return std::normal_distribution<double>()(engine_); }
  Vec3 Direction() { return Normalized(Vec3{Gauss(), Gauss(), Gauss()}); }
  // alphas from 1e-4 to 1, sometimes equal, sometimes 1.
  std::pair<double, double> Alphas() {
    const double a = LogUniform(1e-4, 1), b = LogUniform(1e-4, 1), kind = Uniform(0, 1);
    if (kind < 0.15) return {a, a};
    if (kind < 0.25) return {1, b};
    if (kind < 0.35) return {a, 1};
    return {a, b};
  }
  // A direction of lobe space, most often within some widths of the axis.
  Vec3 Near(double alpha_x, double alpha_y) {
    if (Uniform(0, 1) < 0.4) return Direction();
    const double f = LogUniform(0.05, 20), sign = Uniform(0, 1) < 0.8 ? 1 : -1;
    return Normalized(Vec3{f * alpha_x * Gauss(), f * alpha_y * Gauss(), sign});
  }

 private:
  std::mt19937_64 engine_;
};

TEST(Ssl, Table) {
  const ReferenceTable table("ssl");
  for (std::size_t row = 0; row < table.size(); ++row) {
    double dalpha = 0, dtheta = 0;
    const double alpha = table(row, "alpha"), theta = table(row, "theta"), cond = table(row, "cond");
    const double k = Ssl(alpha, theta, &dalpha, &dtheta);
    ExpectTableValue(table, row, "K", k, cond);
    ExpectTableDerivatives(table, row, {"dK_dalpha", "dK_dtheta"}, {dalpha, dtheta}, 1e-9 * std::fmax(1, cond));
    EXPECT_EQ(Ssl(alpha, theta), k);
  }
}

TEST(Sel, Table) {
  const ReferenceTable table("sel");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const double ax = table(row, "alpha_x"), ay = table(row, "alpha_y");
    const Vec3 rotation = {table(row, "rot_x"), table(row, "rot_y"), table(row, "rot_z")};
    const Vec3 w = {table(row, "wx"), table(row, "wy"), table(row, "wz")};
    const Vec3 v = RotationMatrix(rotation) * w;
    EXPECT_LT(Norm(v - Vec3{table(row, "vx"), table(row, "vy"), table(row, "vz")}), 4 * kEpsilon);
    SelGradient gradient;
    const double k = Sel(ax, ay, rotation, w, &gradient);
    // The table has no condition number at the kink. There cond = (|w_j dK/dw_j| + |r_j dK/dr_j| + 2 a |one-sided|) / K
    // stands in.
    double cond = table(row, "cond");
    if (std::isnan(cond)) {
      SelGradient side;
      Sel(ax, ay, rotation, w, &side, SelKink::kAlphaXLarger);
      cond = (std::fabs(ax * side.dalpha_x) + std::fabs(ay * side.dalpha_y) + Norm(rotation) * Norm(side.drotation) +
              Norm(side.ddirection)) /
             k;
    }
    ExpectTableValue(table, row, "K", k, cond);
    ExpectTableDerivatives(
        table, row, {"dK_dalpha_x", "dK_dalpha_y", "dK_drot_x", "dK_drot_y", "dK_drot_z"},
        {gradient.dalpha_x, gradient.dalpha_y, gradient.drotation.x, gradient.drotation.y, gradient.drotation.z},
        1e-9 * std::fmax(1, cond));
    EXPECT_EQ(Sel(ax, ay, rotation, w), k);
  }
}

TEST(Sel, IntegralTable) {
  const ReferenceTable table("sel_integral");
  for (std::size_t row = 0; row < table.size(); ++row) {
    double dx = 0, dy = 0;
    const double ax = table(row, "alpha_x"), ay = table(row, "alpha_y");
    const double integral = SelIntegral(ax, ay, &dx, &dy);
    EXPECT_NEAR(integral, table(row, "integral"), 1e-12 * integral) << row;
    ExpectTableDerivatives(table, row, {"dintegral_dalpha_x", "dintegral_dalpha_y"}, {dx, dy}, 1e-12);
    EXPECT_EQ(SelIntegral(ax, ay), integral);
  }
}

TEST(Sel, GradientEqualsJets) {
  using Jet = ceres::Jet<double, 5>;
  Random random(11);
  for (int i = 0; i < 2000; ++i) {
    auto [ax, ay] = random.Alphas();
    if (ax == ay) ay *= 0.5;
    const Vec3 v = random.Near(ax, ay);
    SelLobeGradient gradient;
    const double k = SelLobe(ax, ay, v, &gradient);
    const Jet jet = SelLobeFormula(Jet(ax, 0), Jet(ay, 1), Vec3T<Jet>{Jet(v.x, 2), Jet(v.y, 3), Jet(v.z, 4)});
    EXPECT_NEAR(k, jet.a, 8 * kEpsilon * k);
    const double values[5] = {gradient.dalpha_x, gradient.dalpha_y, gradient.dv.x, gradient.dv.y, gradient.dv.z};
    for (int j = 0; j < 5; ++j) EXPECT_NEAR(values[j], jet.v[j], 1e-10 * jet.v.norm()) << i << " " << j;
    EXPECT_NEAR(Dot(gradient.dv, v), -2 * k, 1e-12 * (k + Norm(gradient.dv)));
  }
}

TEST(Sel, PrintedFormulaAgreesWhereItDoesNotCancel) {
  Random random(12);
  for (int i = 0; i < 1000; ++i) {
    const double ax = random.Uniform(0.2, 1), ay = random.Uniform(0.2, 1);
    const Vec3 v = random.Direction();
    const double a = std::pow(std::fmax(ax, ay), 2);
    const double u = std::sqrt(a * (v.x * v.x / (ax * ax) + v.y * v.y / (ay * ay)) + v.z * v.z);
    const double k = 4 * a * a / std::pow((1 + a) * u - v.z * (1 - a), 2);
    EXPECT_NEAR(SelLobe(ax, ay, v), k, 1e-13 * k);
  }
}

TEST(Sel, LawsForHostileParameters) {
  Random random(13);
  for (int i = 0; i < 20000; ++i) {
    const auto [ax, ay] = random.Alphas();
    const double larger = std::fmax(ax, ay);
    const Vec3 v = random.Near(ax, ay);
    const double k = SelLobe(ax, ay, v);
    EXPECT_GT(k, 0);
    EXPECT_LE(k, 1 + 4 * kEpsilon);
    const double bound = Ssl(larger, PolarAngle(v));
    // The bound's own rounding, through its sensitivity to the angle, is part of the comparison.
    double dtheta = 0;
    Ssl(larger, PolarAngle(v), nullptr, &dtheta);
    EXPECT_LE(k, bound * (1 + 32 * kEpsilon) + 4 * kEpsilon * std::fabs(dtheta)) << ax << " " << ay;
    EXPECT_EQ(SelLobe(ax, ay, {-v.x, v.y, v.z}), k);
    EXPECT_EQ(SelLobe(ay, ax, {v.y, v.x, v.z}), k);
    EXPECT_NEAR(SelLobe(ax, ay, {0, 0, 1}), 1, 2 * kEpsilon);
    EXPECT_NEAR(SelLobe(ax, ay, {0, 0, -1}), std::pow(larger, 4), 8 * kEpsilon * std::pow(larger, 4));
    // Equality with the spheroidal lobe in the plane of the larger alpha.
    const double theta = random.Uniform(0, kPi);
    const Vec3 in_plane = ax >= ay ? FromSpherical(theta, 0) : RotateX({0, 0, 1}, theta);
    const double spheroid = Ssl(larger, theta);
    EXPECT_NEAR(SelLobe(ax, ay, in_plane), spheroid, 1e-10 * spheroid);
  }
  EXPECT_EQ(SelLobe(1, 1, Normalized(Vec3{1, 2, -3})), 1);
}

TEST(Sel, OneSidedDerivativesAtEqualAlphas) {
  // MATH.md section 1: at alpha = 0.3 and v ~ (.2, .1, .9) the left derivative is 1.237308, the right one 1.130850.
  const Vec3 v = Normalized(Vec3{0.2, 0.1, 0.9});
  SelLobeGradient plain, right, left;
  const double k = SelLobe(0.3, 0.3, v, &plain);
  EXPECT_TRUE(std::isnan(plain.dalpha_x) && std::isnan(plain.dalpha_y));
  EXPECT_TRUE(std::isfinite(plain.dv.x + plain.dv.y + plain.dv.z));
  EXPECT_EQ(SelLobe(0.3, 0.3, v, &right, SelKink::kAlphaXLarger), k);
  EXPECT_EQ(SelLobe(0.3, 0.3, v, &left, SelKink::kAlphaYLarger), k);
  EXPECT_NEAR(right.dalpha_x, 1.130850, 1e-6);
  EXPECT_NEAR(left.dalpha_x, 1.237308, 1e-6);
  const double h = 1e-7;
  EXPECT_NEAR((SelLobe(0.3 + h, 0.3, v) - k) / h, right.dalpha_x, 1e-5);
  EXPECT_NEAR((k - SelLobe(0.3 - h, 0.3, v)) / h, left.dalpha_x, 1e-5);
  EXPECT_NEAR((SelLobe(0.3, 0.3 + h, v) - k) / h, left.dalpha_y, 1e-5);
  EXPECT_NEAR((k - SelLobe(0.3, 0.3 - h, v)) / h, right.dalpha_y, 1e-5);
  // Away from equality the argument has no effect.
  SelLobeGradient away;
  SelLobe(0.3, 0.31, v, &away, SelKink::kAlphaXLarger);
  SelLobe(0.3, 0.31, v, &plain);
  EXPECT_EQ(away.dalpha_x, plain.dalpha_x);
  double dx = 0, dy = 0;
  SelIntegral(0.3, 0.3, &dx, &dy);
  EXPECT_TRUE(std::isnan(dx) && std::isnan(dy));
  SelIntegral(0.3, 0.3, &dx, &dy, SelKink::kAlphaXLarger);
  EXPECT_NEAR((SelIntegral(0.3 + h, 0.3) - SelIntegral(0.3, 0.3)) / h, dx, 1e-5);
  EXPECT_NEAR((SelIntegral(0.3, 0.3) - SelIntegral(0.3, 0.3 - h)) / h, dy, 1e-5);
}

TEST(Sel, IntegralByQuadrature) {
  for (const auto& [ax, ay] : {std::pair{0.3, 0.1}, {0.05, 0.4}, {1.0, 0.02}, {0.2, 0.2}, {1.0, 1.0}, {0.002, 0.01}}) {
    // Twice the cosine integrals about opposite normals would hide a factor; integrate K itself over stretched azimuth
    // and polar angle.
    const auto outer = [&, ax = ax, ay = ay](double psi) {
      const double x = ax * std::cos(psi), y = ay * std::sin(psi), rho = std::hypot(x, y);
      const auto inner = [&](double tau) {
        const double theta = 2 * std::atan(rho * std::tan(0.5 * tau));
        const double c = std::cos(0.5 * theta), t = std::cos(0.5 * tau);
        const double dtheta = rho * c * c / (t * t);
        const Vec3 v = {std::sin(theta) * x / rho, std::sin(theta) * y / rho, std::cos(theta)};
        return SelLobe(ax, ay, v) * std::sin(theta) * dtheta * ax * ay / (rho * rho);
      };
      return IntegrateAdaptive(inner, 0, kPi - 1e-9, {1e-12, 0, 500});
    };
    const double integral = 4 * IntegrateAdaptive(outer, 0, 0.5 * kPi, {1e-11, 0, 500});
    EXPECT_NEAR(SelIntegral(ax, ay), integral, 1e-9 * integral) << ax << " " << ay;
    EXPECT_GE(SelIntegral(ax, ay), 4 * kPi * ax * ay * (1 - 8 * kEpsilon));
  }
  EXPECT_NEAR(SelIntegral(0.3, 0.1), 0.433368, 1e-6);
  EXPECT_NEAR(SelIntegral(0.07, 0.07), 4 * kPi * 0.07 * 0.07, 4e-16);
}

TEST(Sel, EllipsoidAndItsIntersections) {
  Random random(14);
  for (int i = 0; i < 2000; ++i) {
    auto [ax, ay] = random.Alphas();
    const Vec3 v = random.Near(ax, ay);
    SelHit near, far;
    ASSERT_TRUE(SelIntersect(ax, ay, {0, 0, 0}, v, &near, &far, SelKink::kAlphaXLarger));
    EXPECT_LT(near.t, 0);
    SelLobeGradient gradient;
    const double k = SelLobe(ax, ay, v, &gradient, SelKink::kAlphaXLarger);
    EXPECT_NEAR(far.t * far.t, k, 16 * kEpsilon * k) << ax << " " << ay;
    const double scale = std::fabs(gradient.dalpha_x) + std::fabs(gradient.dalpha_y);
    EXPECT_NEAR(2 * far.t * far.dt_dalpha_x, gradient.dalpha_x, 1e-12 * scale);
    EXPECT_NEAR(2 * far.t * far.dt_dalpha_y, gradient.dalpha_y, 1e-12 * scale);
    // The opposite direction meets the same line behind the origin.
    EXPECT_NEAR(near.t * near.t, SelLobe(ax, ay, -v), 16 * kEpsilon * near.t * near.t);
  }
  const auto [center, axes] = SelEllipsoidOf(0.4, 0.2);
  EXPECT_NEAR(center.z + axes.z, 1, kEpsilon);
  EXPECT_NEAR(axes.z - center.z, 0.16, kEpsilon);
  SelHit near, far;
  // From outside, along y through the centre: at distance 3 -+ alpha_y.
  ASSERT_TRUE(SelIntersect(0.4, 0.2, {0, -3, center.z}, {0, 2, 0}, &near, &far));
  EXPECT_NEAR(near.t, 1.4, 1e-15);
  EXPECT_NEAR(far.t, 1.6, 1e-15);
  EXPECT_NEAR(near.dt_dalpha_y, -0.5, 1e-15);
  EXPECT_NEAR(far.dt_dalpha_y, 0.5, 1e-15);
  EXPECT_FALSE(SelIntersect(0.4, 0.2, {0.41, -3, 0.3}, {0, 1, 0}, &near, &far));
  // Derivatives of a general line by differences.
  const Vec3 origin = {0.1, 2, -0.3}, direction = {0.05, -1.3, 0.4};
  ASSERT_TRUE(SelIntersect(0.4, 0.2, origin, direction, &near, &far));
  SelHit near_h, far_h;
  const double h = 1e-6;
  ASSERT_TRUE(SelIntersect(0.4 + h, 0.2, origin, direction, &near_h, &far_h));
  EXPECT_NEAR((near_h.t - near.t) / h, near.dt_dalpha_x, 1e-4);
  EXPECT_NEAR((far_h.t - far.t) / h, far.dt_dalpha_x, 1e-4);
}

TEST(SelCosine, EqualAlphasAgainstOneDimension) {
  // About its own axis the integrand depends on the polar angle alone.
  for (const double alpha : {1e-4, 0.01, 0.3, 1.0}) {
    const double above = 2 * kPi *
                         IntegrateAdaptive(
                             [&](double tau) {
                               const double theta = 2 * std::atan(alpha * std::tan(0.5 * tau));
                               return alpha * alpha * std::sin(tau) * std::cos(theta);
                             },
                             0, 2 * std::atan(1 / alpha), {1e-13, 0, 500});
    EXPECT_NEAR(SelCosineIntegral(alpha, alpha, {0, 0, 0}, {0, 0, 1}), above, 1e-8 * above);
  }
  EXPECT_NEAR(SelCosineIntegral(1, 1, {0.3, 1, 2}, Normalized(Vec3{1, 2, 3})), kPi, 1e-8);
}

TEST(SelCosine, OppositeNormalsGiveTheSignedMoment) {
  // P(n) - P(-n) = n . M with M = int K w dw along the lobe axis; P(n) + P(-n) <= int K.
  Random random(15);
  for (int i = 0; i < 12; ++i) {
    const double ax = random.LogUniform(0.01, 1), ay = random.LogUniform(0.01, 1);
    const Vec3 rotation = random.Direction(), n = random.Direction();
    const Vec3 axis = RotationMatrix(rotation).row[2];
    const double moment = SelCosineIntegral(ax, ay, rotation, axis) - SelCosineIntegral(ax, ay, rotation, -axis);
    const double plus = SelCosineIntegral(ax, ay, rotation, n), minus = SelCosineIntegral(ax, ay, rotation, -n);
    EXPECT_NEAR(plus - minus, moment * Dot(axis, n), 1e-8 * SelIntegral(ax, ay));
    EXPECT_LE(plus + minus, SelIntegral(ax, ay));
    EXPECT_GT(std::fmin(plus, minus), 0);
  }
}

TEST(SelCosine, GradientByDifferences) {
  Random random(16);
  for (int i = 0; i < 6; ++i) {
    const double ax = random.LogUniform(0.02, 1), ay = random.LogUniform(0.02, 1);
    const Vec3 r = random.Direction(), n = random.Direction();
    const auto f = [](double x, double y, const Vec3& rotation, const Vec3& normal) {
      return SelCosineIntegral(x, y, rotation, normal, nullptr, SelKink::kNone, {1e-12, 0, 4000});
    };
    SelGradient g;
    const double value = SelCosineIntegral(ax, ay, r, n, &g);
    EXPECT_EQ(value, SelCosineIntegral(ax, ay, r, n));
    const double h = 1e-4;
    EXPECT_NEAR((f(ax * (1 + h), ay, r, n) - f(ax * (1 - h), ay, r, n)) / (2 * h * ax), g.dalpha_x, 1e-5 * value / ax);
    EXPECT_NEAR((f(ax, ay * (1 + h), r, n) - f(ax, ay * (1 - h), r, n)) / (2 * h * ay), g.dalpha_y, 1e-5 * value / ay);
    const Vec3 e = {0.6, 0, 0.8};
    const double hr = 1e-4 * std::fmin(ax, ay);
    EXPECT_NEAR((f(ax, ay, r + hr * e, n) - f(ax, ay, r - hr * e, n)) / (2 * hr), Dot(g.drotation, e),
                1e-5 * (Norm(g.drotation) + value));
    EXPECT_NEAR(Dot(g.ddirection, n), value, 1e-12 * value + 1e-14);
  }
  SelGradient g;
  SelCosineIntegral(0.3, 0.3, {0, 0, 0}, {0, 0, 1}, &g);
  EXPECT_TRUE(std::isnan(g.dalpha_x));
  EXPECT_TRUE(std::isfinite(g.ddirection.z));
}

}  // namespace
}  // namespace lobefit
