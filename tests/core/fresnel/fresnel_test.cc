#include "lobefit/core/fresnel/fresnel.h"

#include "tests/support/differences.h"
#include "tests/support/reference_table.h"
#include "tests/support/shapes.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

TEST(FresnelTable, Conductor) {
  const ReferenceTable table("fresnel");
  for (std::size_t row = 0; row < table.size(); ++row) {
    ConductorFresnelGradient gradient;
    const double value = FresnelConductor(table(row, "cos"), {table(row, "eta"), table(row, "k")}, &gradient);
    ExpectTabulated(value, table(row, "F"), row, "F");
    ExpectTabulated(gradient.dc, table(row, "dF_dcos"), row, "dF_dcos");
    ExpectTabulated(gradient.deta, table(row, "dF_deta"), row, "dF_deta");
    ExpectTabulated(gradient.dk, table(row, "dF_dk"), row, "dF_dk");
  }
}

TEST(FresnelJets, Conductor) {
  using Jet = ceres::Jet<double, 3>;
  ShapeGenerator random(11);
  for (int i = 0; i < 1000; ++i) {
    const double c = i % 4 == 0 ? random.LogUniform(1e-6, 1) : random.Uniform(0, 1);
    const double eta = random.LogUniform(0.05, 10), k = random.LogUniform(0.01, 20);
    ConductorFresnelGradient gradient;
    const double value = FresnelConductor(c, {eta, k}, &gradient);
    const Jet jet = FresnelConductorFormula(Jet(c, 0), Jet(eta, 1), Jet(k, 2));
    EXPECT_NEAR(value, jet.a, 1e-12);
    const double entries[3] = {gradient.dc, gradient.deta, gradient.dk};
    ExpectSameGradient(entries, jet.v.data(), 3, 1e-10);
    EXPECT_EQ(value, FresnelConductor(c, {eta, k}));
  }
}

TEST(FresnelLaws, LimitsAndRange) {
  ShapeGenerator random(12);
  for (int i = 0; i < 200; ++i) {
    const double eta = random.LogUniform(0.05, 10), k = random.LogUniform(0.01, 20), f0 = random.Uniform(0, 1);
    const double normal = ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
    EXPECT_NEAR(FresnelConductor(1, {eta, k}), normal, 1e-14);
    EXPECT_EQ(FresnelConductor(0, {eta, k}), 1);
    EXPECT_NEAR(FresnelDielectric(1, eta), (eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1)), 1e-14);
    EXPECT_EQ(FresnelDielectric(0, eta), 1);
    EXPECT_EQ(FresnelSchlick(1, f0), f0);
    EXPECT_EQ(FresnelSchlick(0, f0), 1);
    const double c = random.Uniform(0, 1), f = FresnelConductor(c, {eta, k});
    EXPECT_GT(f, 0);
    EXPECT_LE(f, 1);
  }
}

// A dielectric is the limit of a conductor that does not absorb, on both sides of total reflection.
TEST(FresnelLaws, DielectricIsTheLimitOfSmallAbsorption) {
  for (const double n : {0.4, 0.7, 1.3, 1.5, 2.4}) {
    for (const double c : {0.05, 0.3, 0.6, 0.9, 1.0}) {
      double dc, dn;
      ConductorFresnelGradient conductor;
      const double value = FresnelDielectric(c, n, &dc, &dn);
      EXPECT_NEAR(value, FresnelConductor(c, {n, 1e-13}, &conductor), 1e-9) << n << " " << c;
      EXPECT_NEAR(dc, conductor.dc, 1e-8) << n << " " << c;
      EXPECT_NEAR(dn, conductor.deta, 1e-8) << n << " " << c;
    }
  }
}

// Brewster's angle tan = n: only s-polarised light is reflected, F = ((n^2 - 1) / (n^2 + 1))^2 / 2.
TEST(FresnelLaws, BrewsterAngle) {
  const double n = 1.5, c = 1 / std::sqrt(1 + n * n), rs = (n * n - 1) / (n * n + 1);
  EXPECT_NEAR(FresnelDielectric(c, n), 0.5 * rs * rs, 1e-15);
}

TEST(FresnelSchlickGradient, AgreesWithJets) {
  using Jet = ceres::Jet<double, 2>;
  for (const double c : {0.0, 1e-6, 0.3, 0.99, 1.0}) {
    for (const double f0 : {0.0, 0.04, 0.9}) {
      double dc, df0;
      FresnelSchlick(c, f0, &dc, &df0);
      const Jet jet_c(c, 0), jet_f0(f0, 1);
      const Jet m = 1.0 - jet_c;
      const Jet jet = jet_f0 + (1.0 - jet_f0) * m * m * m * m * m;
      EXPECT_NEAR(dc, jet.v[0], 1e-14);
      EXPECT_NEAR(df0, jet.v[1], 1e-14);
    }
  }
}

TEST(SchlickF82, TintIsThatOfTheEdge) {
  for (const double f0 : {0.0, 0.04, 0.6, 1.0}) {
    for (const double tint : {0.3, 1.0, 1.2}) {
      EXPECT_NEAR(FresnelSchlickF82(1.0 / 7, f0, tint), tint * FresnelSchlick(1.0 / 7, f0), 1e-15);
      EXPECT_EQ(FresnelSchlickF82(1, f0, tint), f0);
      EXPECT_EQ(FresnelSchlickF82(0, f0, tint), 1);
      for (const double c : {0.02, 0.15, 0.5, 0.93}) {
        if (tint == 1) {
          EXPECT_EQ(FresnelSchlickF82(c, f0, tint), FresnelSchlick(c, f0));
        }
        SchlickF82Gradient g;
        FresnelSchlickF82(c, f0, tint, &g);
        EXPECT_NEAR(g.dc, Difference([&](double x) { return FresnelSchlickF82(x, f0, tint); }, c, 1e-3), 1e-9);
        EXPECT_NEAR(g.df0, Difference([&](double x) { return FresnelSchlickF82(c, x, tint); }, f0, 1e-3), 1e-11);
        EXPECT_NEAR(g.dtint, Difference([&](double x) { return FresnelSchlickF82(c, f0, x); }, tint, 1e-3), 1e-11);
        const double b = SchlickF82Coefficient(f0, tint), edge = c * std::pow(1 - c, 6);
        EXPECT_NEAR(FresnelSchlickF82(c, f0, tint), FresnelSchlick(c, f0) - b * edge, 1e-14);
      }
    }
  }
}

TEST(FresnelCurve, IsAPartitionOfOne) {
  for (double c = 0; c <= 1; c += 1.0 / 256) {
    double basis[kFresnelCurveSize], slope[kFresnelCurveSize], sum = 0, slopes = 0;
    FresnelCurveBasis(c, basis, slope);
    for (std::size_t k = 0; k < kFresnelCurveSize; ++k) {
      EXPECT_GE(basis[k], 0);
      sum += basis[k];
      slopes += slope[k];
    }
    EXPECT_NEAR(sum, 1, 1e-15);
    EXPECT_NEAR(slopes, 0, 1e-13);
  }
  double basis[kFresnelCurveSize];
  FresnelCurveBasis(0, basis);
  EXPECT_EQ(basis[0], 1);
  FresnelCurveBasis(1, basis);
  EXPECT_EQ(basis[5], 1);
}

TEST(FresnelCurve, SlopesAreDerivatives) {
  for (const double c : {0.1, 0.4, 0.9}) {
    double slope[kFresnelCurveSize], basis[kFresnelCurveSize];
    FresnelCurveBasis(c, basis, slope);
    for (std::size_t k = 0; k < kFresnelCurveSize; ++k) {
      const auto b = [&](double x) {
        double values[kFresnelCurveSize];
        FresnelCurveBasis(x, values);
        return values[k];
      };
      EXPECT_NEAR(slope[k], Difference(b, c, 1e-2), 1e-12);
    }
  }
}

TEST(FresnelCurve, FollowsSchlick) {
  for (const double f0 : {0.0, 0.04, 0.5, 0.95}) {
    double coefficients[kFresnelCurveSize], worst = 0;
    FresnelCurveOfSchlick(f0, coefficients);
    for (double c = 0; c <= 1; c += 1.0 / 512) {
      double basis[kFresnelCurveSize], F = 0;
      FresnelCurveBasis(c, basis);
      for (std::size_t k = 0; k < kFresnelCurveSize; ++k) {
        EXPECT_TRUE(coefficients[k] >= 0 && coefficients[k] <= 1);
        F += coefficients[k] * basis[k];
      }
      worst = std::fmax(worst, std::abs(F - FresnelSchlick(c, f0)));
    }
    EXPECT_LT(worst, f0 == 0 ? 0.006 : 0.0017) << f0;
  }
}

// [MATH.md 8.4] the closed form where it has digits; and both sides of the same surface.
TEST(DielectricMeanReflectance, IsTheClosedForm) {
  EXPECT_EQ(DielectricMeanReflectance(1), 0);
  for (const double n : {1.15, 1.5, 2.4, 4.0}) {
    const double n2 = n * n, n4 = n2 * n2;
    const double closed = 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
                          n2 * std::pow(n2 - 1, 2) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
                          2 * n * n2 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
                          8 * n4 * (n4 + 1) / ((n2 + 1) * std::pow(n4 - 1, 2)) * std::log(n);
    double slope;
    EXPECT_NEAR(DielectricMeanReflectance(n, &slope), closed, 1e-14);
    EXPECT_NEAR(slope, Difference([](double x) { return DielectricMeanReflectance(x); }, n, 1e-3), 1e-10);
  }
}

TEST(DielectricTransmittance, IsWhatIsNotReflected) {
  for (const double n : {1.0, 1.0001, 1.5, 3.0}) {
    for (const double c : {1e-5, 0.01, 0.4, 1.0}) {
      EXPECT_NEAR(DielectricTransmittance(c, n) + FresnelDielectric(c, n), 1, 1e-15);
      if (n > 1.1 && c > 0.1 && c < 1) {
        double dc, dn;
        DielectricTransmittance(c, n, &dc, &dn);
        EXPECT_NEAR(dc, Difference([&](double x) { return DielectricTransmittance(x, n); }, c, 1e-3), 1e-9);
        EXPECT_NEAR(dn, Difference([&](double x) { return DielectricTransmittance(c, x); }, n, 1e-3), 1e-9);
      }
    }
  }
  // Towards grazing T is linear in the cosine.
  EXPECT_NEAR(DielectricTransmittance(2e-9, 1.5) / DielectricTransmittance(1e-9, 1.5), 2, 1e-7);
}

}  // namespace
}  // namespace lobefit
