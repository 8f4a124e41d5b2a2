#include "lobefit/core/microfacet/ellipsoid_brdf.h"

#include "tests/support/reference_table.h"
#include "tests/support/shapes.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

TEST(BrdfTable, EllipsoidConductor) {
  const ReferenceTable table("brdf");
  std::vector<std::string> names = kEllipsoidNames;
  names.insert(names.end(), {"eta", "k"});
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Vec3 wo = DirectionOfRow(table, row, "o"), wi = DirectionOfRow(table, row, "i");
    double gradient[7];
    BrdfFactors factors;
    const double value = EllipsoidConductorBrdf(EllipsoidOfRow(table, row), {table(row, "eta"), table(row, "k")}, wo,
                                                wi, Masking::kSmithSeparable, gradient, &factors);
    const double cond = table(row, "cond");
    ExpectValue(value, table(row, "fr"), cond, row);
    ExpectGradient(gradient, table, row, "dfr_d", names, cond);
    ExpectValue(factors.D, table(row, "D"), cond, row);
    ExpectValue(factors.G1_o, table(row, "G1_o"), cond, row);
    ExpectValue(factors.G1_i, table(row, "G1_i"), cond, row);
    ExpectValue(factors.F, table(row, "F"), cond, row);
    EXPECT_EQ(factors.clamped_o, table(row, "clamped_o") == 1) << row;
    EXPECT_EQ(factors.clamped_i, table(row, "clamped_i") == 1) << row;
  }
}

// A pair of directions that mirrors about a normal near the lobe, both above the horizon; or any pair.
void RandomPair(ShapeGenerator* random, const Ellipsoid& e, Vec3* wo, Vec3* wi) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    *wo = random->Upper();
    const Vec3 m = random->NearLobe(e);
    *wi = Normalized((2 * Dot(*wo, m)) * m - *wo);
    if (wi->z > 1e-3) return;
  }
  *wi = random->Upper();
}

// Derivative along a tangent of a direction: its component perpendicular to the direction is all that has a meaning.
void ExpectSameTangent(const Vec3& w, const Vec3& gradient, const double* jet) {
  const Vec3 expected = {jet[0], jet[1], jet[2]};
  const double along = Dot(w, expected), ours = Dot(w, gradient);
  const Vec3 a = gradient - ours * w, b = expected - along * w;
  const double entries[3] = {a.x, a.y, a.z}, reference[3] = {b.x, b.y, b.z};
  ExpectSameGradient(entries, reference, 3, 1e-9);
}

TEST(BrdfJets, EllipsoidConductor) {
  using Jet = ceres::Jet<double, 13>;
  ShapeGenerator random(21);
  for (int i = 0; i < 1000; ++i) {
    const Ellipsoid e = i % 2 == 0 ? random.Moderate() : random.Hostile();
    Vec3 wo, wi;
    RandomPair(&random, e, &wo, &wi);
    const double eta = random.LogUniform(0.05, 5), k = random.LogUniform(0.01, 10);
    for (const Masking kind : {Masking::kSmithSeparable, Masking::kSmithUnclamped}) {
      double gradient[7];
      BrdfDirectionGradient direction;
      const double value = EllipsoidConductorBrdf(e, {eta, k}, wo, wi, kind, gradient, nullptr, &direction);
      const Jet p[7] = {Jet(e.alpha_x, 0), Jet(e.alpha_y, 1), Jet(e.theta_x, 2), Jet(e.theta_y, 3),
                        Jet(e.theta_z, 4), Jet(eta, 5),       Jet(k, 6)};
      const Vec3T<Jet> jo = {Jet(wo.x, 7), Jet(wo.y, 8), Jet(wo.z, 9)},
                       ji = {Jet(wi.x, 10), Jet(wi.y, 11), Jet(wi.z, 12)};
      const Jet jet = EllipsoidConductorBrdfFormula(p, jo, ji, kind == Masking::kSmithSeparable);
      EXPECT_NEAR(value, jet.a, 1e-10 * value);
      ExpectSameGradient(gradient, jet.v.data(), 7, 1e-10);
      ExpectSameTangent(wo, direction.wo, jet.v.data() + 7);
      ExpectSameTangent(wi, direction.wi, jet.v.data() + 10);
      EXPECT_EQ(value, EllipsoidConductorBrdf(e, {eta, k}, wo, wi, kind));
    }
  }
}

TEST(BrdfLaws, ReciprocalInValueAndGradient) {
  ShapeGenerator random(22);
  for (int i = 0; i < 500; ++i) {
    const Ellipsoid e = random.Hostile();
    Vec3 wo, wi;
    RandomPair(&random, e, &wo, &wi);
    double a[7], b[7];
    EXPECT_EQ(EllipsoidConductorBrdf(e, {0.2, 3}, wo, wi, Masking::kSmithSeparable, a),
              EllipsoidConductorBrdf(e, {0.2, 3}, wi, wo, Masking::kSmithSeparable, b));
    for (int k = 0; k < 7; ++k) EXPECT_EQ(a[k], b[k]);
    EXPECT_GT(EllipsoidConductorBrdf(e, {0.2, 3}, wo, wi, Masking::kSmithSeparable), 0);
    EXPECT_GE(EllipsoidConductorBrdf(e, {0.2, 3}, wo, wi, Masking::kSmithUnclamped),
              EllipsoidConductorBrdf(e, {0.2, 3}, wo, wi, Masking::kSmithSeparable));
  }
}

TEST(BrdfLaws, SchlickIsLinearInF0AndSharesTheSpecularFactor) {
  ShapeGenerator random(23);
  for (int i = 0; i < 200; ++i) {
    const Ellipsoid e = random.Moderate();
    Vec3 wo, wi;
    RandomPair(&random, e, &wo, &wi);
    double gradient[6], conductor[7];
    BrdfFactors factors, conductor_factors;
    BrdfDirectionGradient direction;
    const double f = EllipsoidSchlickBrdf(e, 0.3, wo, wi, Masking::kSmithSeparable, gradient, &factors, &direction);
    const double f_zero = EllipsoidSchlickBrdf(e, 0, wo, wi, Masking::kSmithSeparable);
    EXPECT_NEAR(f, f_zero + 0.3 * gradient[5], 1e-14 * f);
    const double g =
        EllipsoidConductorBrdf(e, {0.2, 3}, wo, wi, Masking::kSmithSeparable, conductor, &conductor_factors);
    EXPECT_NEAR(f / factors.F, g / conductor_factors.F, 1e-14 * f / factors.F);
    for (int k = 0; k < 5; ++k) {
      EXPECT_NEAR(gradient[k] / factors.F, conductor[k] / conductor_factors.F,
                  1e-14 * std::abs(gradient[k]) / factors.F);
    }
    // Direction gradient against a central difference along a tangent (step 1e-5: error 1e-10 of the curvature).
    const Vec3 tangent = Normalized(Cross(wo, Vec3{0.3, -0.5, 0.8}));
    const double h = 1e-5 * e.alpha_x * e.alpha_y;
    const double difference =
        (EllipsoidSchlickBrdf(e, 0.3, Normalized(wo + h * tangent), wi, Masking::kSmithUnclamped) -
         EllipsoidSchlickBrdf(e, 0.3, Normalized(wo - h * tangent), wi, Masking::kSmithUnclamped)) /
        (2 * h);
    EllipsoidSchlickBrdf(e, 0.3, wo, wi, Masking::kSmithUnclamped, nullptr, nullptr, &direction);
    EXPECT_NEAR(Dot(direction.wo, tangent), difference, 1e-5 * (Norm(direction.wo) + f / e.alpha_y)) << i;
  }
}

TEST(BrdfLaws, NothingBelowTheHorizon) {
  const Vec3 up = Normalized(Vec3{0.2, 0.1, 1}), level = {1, 0, 0}, down = {0, 0.6, -0.8};
  for (const Vec3& w : {level, down}) {
    double gradient[7] = {1, 1, 1, 1, 1, 1, 1};
    EXPECT_EQ(EllipsoidConductorBrdf({}, {1, 1}, up, w, Masking::kSmithSeparable, gradient), 0);
    for (const double d : gradient) EXPECT_EQ(d, 0);
    EXPECT_EQ(EllipsoidSchlickBrdf({}, 0.5, w, up, Masking::kSmithSeparable, gradient), 0);
    EXPECT_EQ(LambertBrdf(0.5, up, w), 0);
  }
  double derivative;
  EXPECT_EQ(LambertBrdf(0.5, up, up, &derivative), 0.5 * kInvPi);
  EXPECT_EQ(derivative, kInvPi);
}

}  // namespace
}  // namespace lobefit
