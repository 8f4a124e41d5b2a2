#include "lobefit/core/radial/smith.h"

#include "tests/support/reference_table.h"
#include "tests/support/shapes.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "lobefit/core/ellipsoid/ellipsoid.h"
#include "lobefit/core/masking/g2.h"
#include "lobefit/core/radial/slope_distribution.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

const std::vector<std::string> kSlopeNames = {"alpha_x", "alpha_y", "r", "slope_x", "slope_y"};

SlopeDistribution SlopesOfRow(const ReferenceTable& table, std::size_t row) {
  const Family kind = table.Text(row, "kind") == "ggx" ? Family::kGgx : Family::kBeckmann;
  return {kind,
          table(row, "alpha_x"),
          table(row, "alpha_y"),
          table(row, "r"),
          table(row, "slope_x"),
          table(row, "slope_y")};
}

SlopeDistribution RandomSlopes(ShapeGenerator* random, Family kind) {
  return {kind,
          random->LogUniform(0.05, 1.5),
          random->LogUniform(0.05, 1.5),
          random->Uniform(-0.9, 0.9),
          random->Uniform(-1, 1),
          random->Uniform(-1, 1)};
}

TEST(SlopeTables, OffCenterD) {
  const ReferenceTable table("offcenter_D");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const SlopeDistribution s = SlopesOfRow(table, row);
    const Vec3 m = DirectionOfRow(table, row, "m");
    const double cond = table(row, "cond");
    double gradient[5];
    ExpectValue(SlopeDistributionD(s, m, gradient), table(row, "D"), cond, row);
    ExpectGradient(gradient, table, row, "dD_d", kSlopeNames, cond);
    ExpectValue(SlopeP22(s, -m.x / m.z, -m.y / m.z), table(row, "P22"), cond, row);
  }
}

TEST(SlopeTables, SmithLambda) {
  const ReferenceTable table("smith_lambda");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const SlopeDistribution s = SlopesOfRow(table, row);
    const Vec3 u = DirectionOfRow(table, row, "u");
    const double cond_sigma = table(row, "cond_sigma"), cond_Lambda = table(row, "cond_Lambda");
    const ProjectedSlopes p = ProjectSlopes(s, u);
    ExpectTabulated(p.c, table(row, "c"), row, "c");
    ExpectTabulated(p.q, table(row, "q"), row, "q");
    ExpectTabulated(p.a, table(row, "a"), row, "a");
    double gradient[5];
    ExpectValue(SmithLambda(s, u, gradient), table(row, "Lambda"), cond_Lambda, row);
    ExpectGradient(gradient, table, row, "dLambda_d", kSlopeNames, cond_Lambda);
    ExpectValue(SmithSigma(s, u, gradient), table(row, "sigma"), cond_sigma, row);
    ExpectGradient(gradient, table, row, "dsigma_d", kSlopeNames, cond_sigma);
    bool clamped;
    ExpectValue(SmithG1Clamped(s, u, gradient, &clamped), table(row, "G1_clamped"), cond_sigma, row);
    EXPECT_EQ(clamped, table(row, "clamped") == 1) << row;
    EXPECT_NEAR(SmithLambdaOfA(s.family, p.a), SmithLambda(s, u), 1e-13 * std::abs(SmithLambda(s, u))) << row;
  }
}

TEST(SlopeTables, G2) {
  const ReferenceTable table("g2");
  const Masking kinds[4] = {Masking::kSmithSeparable, Masking::kSmithHeight, Masking::kSmithDirection,
                            Masking::kSmithHeightDirection};
  const std::string names[4] = {"G2_separable", "G2_height", "G2_direction", "G2_height_direction"};
  for (std::size_t row = 0; row < table.size(); ++row) {
    const SlopeDistribution s = SlopesOfRow(table, row);
    const Vec3 wo = DirectionOfRow(table, row, "o"), wi = DirectionOfRow(table, row, "i");
    double dLambda_o[5], dLambda_i[5];
    const double Lambda_o = SmithLambda(s, wo, dLambda_o), Lambda_i = SmithLambda(s, wi, dLambda_i);
    const double phi = AzimuthDifference(wo, wi), lambda = VanGinnekenLambda(phi);
    EXPECT_NEAR(Lambda_o, table(row, "Lambda_o"), 1e-12 * std::abs(table(row, "Lambda_o"))) << "row " << row;
    EXPECT_NEAR(Lambda_i, table(row, "Lambda_i"), 1e-12 * std::abs(table(row, "Lambda_i"))) << "row " << row;
    ExpectTabulated(phi, table(row, "phi"), row, "phi");
    ExpectTabulated(lambda, table(row, "lambda"), row, "lambda");
    for (int k = 0; k < 4; ++k) {
      SmithG2Gradient g;
      ExpectTabulated(SmithG2(kinds[k], Lambda_o, Lambda_i, lambda, &g), table(row, names[k]), row, names[k]);
      double gradient[5];
      for (int j = 0; j < 5; ++j) gradient[j] = g.dLambda_o * dLambda_o[j] + g.dLambda_i * dLambda_i[j];
      ExpectGradient(gradient, table, row, "d" + names[k] + "_d", kSlopeNames, 1);
    }
  }
}

TEST(SlopeTables, VCavity) {
  const ReferenceTable table("vcavity");
  const std::vector<std::string> angles = {"theta_o", "phi_o", "theta_i", "phi_i", "theta_m", "phi_m"};
  for (std::size_t row = 0; row < table.size(); ++row) {
    double v[6];
    for (std::size_t k = 0; k < 6; ++k) v[k] = table(row, angles[k]);
    double dG1_o[6], dG2[6];
    const VCavityValues g = VCavity({v[0], v[1], v[2], v[3], v[4], v[5]}, dG1_o, dG2);
    ExpectTabulated(g.G1_o, table(row, "G1_o"), row, "G1_o");
    ExpectTabulated(g.G1_i, table(row, "G1_i"), row, "G1_i");
    ExpectTabulated(g.G2, table(row, "G2"), row, "G2");
    ExpectGradient(dG1_o, table, row, "dG1o_d", angles, 1e-3);
    ExpectGradient(dG2, table, row, "dG2_d", angles, 1e-3);
    const Vec3 wo = FromSpherical(v[0], v[1]), m = FromSpherical(v[4], v[5]);
    EXPECT_NEAR(VCavityG1(wo, m), g.G1_o, 1e-9);
  }
}

TEST(SlopeJets, DistributionAndLambda) {
  using Jet = ceres::Jet<double, 8>;
  ShapeGenerator random(41);
  for (int i = 0; i < 1000; ++i) {
    const SlopeDistribution s = RandomSlopes(&random, i % 2 == 0 ? Family::kGgx : Family::kBeckmann);
    const double values[5] = {s.alpha_x, s.alpha_y, s.r, s.slope_x, s.slope_y};
    Jet p[5];
    for (int k = 0; k < 5; ++k) p[k] = Jet(values[k], k);
    const double f = random.Uniform(0, 2), phi = random.Uniform(-kPi, kPi);
    const Vec3 m =
        Normalized(Vec3{-s.slope_x - f * s.alpha_x * std::cos(phi), -s.slope_y - f * s.alpha_y * std::sin(phi), 1});
    double gradient[8];
    Vec3 dw;
    const double D = SlopeDistributionD(s, m, gradient, &dw);
    gradient[5] = dw.x, gradient[6] = dw.y, gradient[7] = dw.z;
    const Jet jet = SlopeDistributionDFormula(s.family, p, Vec3T<Jet>{Jet(m.x, 5), Jet(m.y, 6), Jet(m.z, 7)});
    EXPECT_NEAR(D, jet.a, 1e-10 * D);
    ExpectSameGradient(gradient, jet.v.data(), 8, 1e-10);
    EXPECT_EQ(D, SlopeDistributionD(s, m));

    const double a = random.Uniform(0, 1) < 0.5 ? random.Uniform(0.1, 3) : -random.Uniform(0.1, 3);
    double dLambda;
    const double Lambda = SmithLambdaOfA(s.family, a, &dLambda);
    const Jet jet_Lambda = SmithLambdaFormula(s.family, Jet(a, 0));
    EXPECT_NEAR(Lambda, jet_Lambda.a, 1e-10 * std::abs(Lambda) + 1e-15);
    EXPECT_NEAR(dLambda, jet_Lambda.v[0], 1e-10 * std::abs(dLambda) + 1e-15);
  }
}

// sigma in its own coordinates by a central difference in the direction (its gradient in the parameters is in the
// table).
TEST(SmithSigma, DirectionGradient) {
  ShapeGenerator random(42);
  for (int i = 0; i < 300; ++i) {
    const SlopeDistribution s = RandomSlopes(&random, i % 2 == 0 ? Family::kGgx : Family::kBeckmann);
    const Vec3 u = Normalized(Vec3{random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)});
    Vec3 du;
    SmithSigma(s, u, nullptr, &du);
    const double h = 1e-5, entries[3] = {du.x, du.y, du.z};
    const Vec3 steps[3] = {{h, 0, 0}, {0, h, 0}, {0, 0, h}};
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(entries[k], (SmithSigma(s, u + steps[k]) - SmithSigma(s, u - steps[k])) / (2 * h), 1e-6);
    }
  }
}

// The GGX member is the ellipsoid distribution in other coordinates.
TEST(SlopeLaws, GgxIsTheEllipsoid) {
  ShapeGenerator random(43);
  for (int i = 0; i < 500; ++i) {
    const Ellipsoid e = random.Moderate();
    const SlopeDistribution s = SlopesFromOffCenter(Family::kGgx, OffCenterFromEllipsoid(e));
    const Vec3 m = random.NearLobe(e), u = random.Sphere();
    EXPECT_NEAR(SlopeDistributionD(s, m), EllipsoidD(e, m), 1e-9 * EllipsoidD(e, m));
    EXPECT_NEAR(SmithSigma(s, u), EllipsoidSigma(e, u), 1e-9 * EllipsoidSigma(e, u));
    double jacobian[25];
    const OffCenter o = OffCenterFromSlopes(s, jacobian), direct = OffCenterFromEllipsoid(e);
    EXPECT_NEAR(o.q12, direct.q12, 1e-14);
    const SlopeDistribution moved = {s.family, s.alpha_x + 1e-6, s.alpha_y, s.r + 1e-6, s.slope_x, s.slope_y};
    EXPECT_NEAR(OffCenterFromSlopes(moved).q12 - o.q12, 1e-6 * (jacobian[15] + jacobian[17]), 1e-11);
  }
}

// int P22 = 1, int D (m.n) dm = 1 and sigma = int D <m.u> dm, all as integrals over slopes in polar coordinates around
// the mean: D dm = P22 dx dy / m_z. The GGX tail r > R is taken by r = tan.
TEST(SlopeLaws, NormalisedAndProjected) {
  ShapeGenerator random(44);
  static const QuadratureRule rule = GaussLegendre(200);
  for (int i = 0; i < 12; ++i) {
    const SlopeDistribution s = RandomSlopes(&random, i % 2 == 0 ? Family::kGgx : Family::kBeckmann);
    const Vec3 u = Normalized(Vec3{random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-0.3, 1)});
    const double root = std::sqrt(1 - s.r * s.r);
    double sum = 0, sigma = 0, dsum[5] = {};
    const int azimuths = 400;
    for (int j = 0; j < azimuths; ++j) {
      const double phi = 2 * kPi * (j + 0.5) / azimuths;
      for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
        const double t = 0.25 * kPi * (1 + rule.nodes[k]), r = std::tan(t),
                     dr = 0.25 * kPi * rule.weights[k] * (1 + r * r);
        const double X = r * std::cos(phi), Y = s.r * X + root * r * std::sin(phi);
        const double x = s.slope_x + s.alpha_x * X, y = s.slope_y + s.alpha_y * Y;
        const double weight = s.alpha_x * s.alpha_y * root * r * dr * 2 * kPi / azimuths;
        double gradient[5];
        const double p = SlopeP22(s, x, y, gradient);
        sum += weight * p;
        for (int n = 0; n < 5; ++n) dsum[n] += weight * gradient[n];
        sigma += weight * p * std::fmax(0, u.z - x * u.x - y * u.y);
      }
    }
    EXPECT_NEAR(sum, 1, 1e-10);
    for (const double d : dsum) EXPECT_NEAR(d, 0, 1e-8);
    EXPECT_NEAR(sigma, SmithSigma(s, u), 2e-4 * sigma + 1e-9);  // the kink of max(0, .) limits this rule
  }
}

TEST(SlopeLaws, G2Orderings) {
  ShapeGenerator random(45);
  for (int i = 0; i < 5000; ++i) {
    const double Lambda_o = i % 10 == 0 ? 0 : random.LogUniform(1e-6, 1e3), Lambda_i = random.LogUniform(1e-6, 1e3);
    const double lambda = VanGinnekenLambda(random.Uniform(0, kPi));
    const double separable = SmithG2(Masking::kSmithSeparable, Lambda_o, Lambda_i, lambda);
    const double height = SmithG2(Masking::kSmithHeight, Lambda_o, Lambda_i, lambda);
    const double direction = SmithG2(Masking::kSmithDirection, Lambda_o, Lambda_i, lambda);
    const double both = SmithG2(Masking::kSmithHeightDirection, Lambda_o, Lambda_i, lambda);
    const double least = std::fmin(1 / (1 + Lambda_o), 1 / (1 + Lambda_i));
    const double slack = 1 + 1e-15;
    EXPECT_LE(separable, height * slack);
    EXPECT_LE(height, both * slack);
    EXPECT_LE(both, least * slack);
    EXPECT_LE(separable, direction * slack);
    EXPECT_LE(direction, least * slack);
    for (const Masking kind :
         {Masking::kSmithSeparable, Masking::kSmithHeight, Masking::kSmithDirection, Masking::kSmithHeightDirection}) {
      SmithG2Gradient a, b;
      EXPECT_EQ(SmithG2(kind, Lambda_o, Lambda_i, lambda, &a), SmithG2(kind, Lambda_i, Lambda_o, lambda, &b));
      EXPECT_EQ(a.dLambda_o, b.dLambda_i);
      const double h = 1e-6;
      EXPECT_NEAR(
          a.dlambda,
          (SmithG2(kind, Lambda_o, Lambda_i, lambda + h) - SmithG2(kind, Lambda_o, Lambda_i, lambda - h)) / (2 * h),
          1e-8);
    }
  }
  double derivative;
  EXPECT_NEAR(VanGinnekenLambda(kPi, &derivative), 0.93268, 1e-5);
  EXPECT_NEAR(derivative, (VanGinnekenLambda(kPi + 1e-5) - VanGinnekenLambda(kPi - 1e-5)) / 2e-5, 1e-9);
}

// Gradients of the small closed forms against central differences.
TEST(ComparisonMasking, Gradients) {
  ShapeGenerator random(46);
  const auto expect_gradient = [](const Vec3& at, const Vec3& gradient, const auto& f) {
    const double h = 1e-6, entries[3] = {gradient.x, gradient.y, gradient.z};
    const Vec3 steps[3] = {{h, 0, 0}, {0, h, 0}, {0, 0, h}};
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(entries[k], (f(at + steps[k]) - f(at - steps[k])) / (2 * h), 1e-6 * (1 + std::abs(entries[k])));
  };
  for (int i = 0; i < 200; ++i) {
    const Vec3 w = Normalized(Vec3{random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(0.2, 1)});
    const Vec3 m = Normalized(Vec3{random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(0.3, 1)});
    if (Dot(w, m) < 0.2) continue;
    Vec3 dw, dm;
    VCavityG1(w, m, &dw, &dm);
    expect_gradient(w, dw, [&](const Vec3& x) { return VCavityG1(x, m); });
    expect_gradient(m, dm, [&](const Vec3& x) { return VCavityG1(w, x); });
    KelemenG1(w, m, &dw, &dm);
    expect_gradient(w, dw, [&](const Vec3& x) { return KelemenG1(x, m); });
    expect_gradient(m, dm, [&](const Vec3& x) { return KelemenG1(w, x); });
    double derivative;
    SchlickSmithG1(w, 0.4, &derivative, &dw);
    expect_gradient(w, dw, [&](const Vec3& x) { return SchlickSmithG1(x, 0.4); });
    EXPECT_NEAR(derivative, (SchlickSmithG1(w, 0.4 + 1e-6) - SchlickSmithG1(w, 0.4 - 1e-6)) / 2e-6, 1e-8);
    ImplicitG1(w, &dw);
    expect_gradient(w, dw, [&](const Vec3& x) { return ImplicitG1(x); });
  }
}

}  // namespace
}  // namespace lobefit
