#include "lobefit/core/fresnel/fresnel.h"

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

}  // namespace
}  // namespace lobefit
