#include "lobefit/core/microfacet/energy.h"

#include "tests/support/reference_table.h"
#include "tests/support/shapes.h"
#include <gtest/gtest.h>

#include "lobefit/core/fresnel/fresnel.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

constexpr double kTableTolerance = 1e-9;  // quadrature tables

const FresnelOfCosine kPerfect = [](double) { return 1.0; };

TEST(EnergyTable, WhiteFurnace) {
  const ReferenceTable table("white_furnace");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const EllipsoidDistribution distribution(EllipsoidOfRow(table, row));
    const Vec3 wo = DirectionOfRow(table, row, "o");
    double gradient[5];
    EXPECT_NEAR(WeakFurnaceSphere(distribution, {}, wo, gradient), table(row, "W_sphere"), 1e-14) << row;
    ExpectGradient(gradient, table, row, "dWsphere_d", kEllipsoidNames, 1);
    const double W = WeakFurnaceHemisphere(distribution, {}, wo, gradient);
    EXPECT_NEAR(W, table(row, "W_hemi"), kTableTolerance * W) << row;
    ExpectGradient(gradient, table, row, "dWhemi_d", kEllipsoidNames, 1);
    const double albedo = table(row, "albedo_F1");
    if (!std::isnan(albedo)) {
      EXPECT_NEAR(DirectionalAlbedo(distribution, {}, kPerfect, wo), albedo, kTableTolerance * albedo) << row;
    }
  }
}

Vec3 AtAngle(double theta) { return FromSpherical(theta, 0); }

// Values of an independent quadrature (MATH.md section 4), alpha 0.5 at theta 0.3, 1 and 1.4; the leaning lobe seen
// from azimuth 0.6.
TEST(WeakFurnace, KnownValues) {
  const SlopeNormalDistribution ggx({Family::kGgx, 0.5, 0.5, 0, 0, 0}),
      beckmann({Family::kBeckmann, 0.5, 0.5, 0, 0, 0});
  const SlopeNormalDistribution leaning({Family::kGgx, 0.3, 0.4, 0.2, 0.4, -0.1});
  const double theta[3] = {0.3, 1.0, 1.4};
  const double hemisphere[3] = {0.80137, 0.83325, 0.92534}, implicit[3] = {0.955, 0.544, 0.240},
               kelemen[3] = {1.113, 1.067, 0.755};
  const double v_cavity[3] = {0.9159, 0.6367, 0.4289};
  for (int i = 0; i < 3; ++i) {
    const Vec3 wo = AtAngle(theta[i]);
    EXPECT_NEAR(WeakFurnaceHemisphere(ggx, {}, wo), hemisphere[i], 6e-6);
    EXPECT_NEAR(WeakFurnaceSphere(beckmann, {Masking::kImplicit}, wo), implicit[i], 6e-4);
    EXPECT_NEAR(WeakFurnaceSphere(beckmann, {Masking::kKelemen}, wo), kelemen[i], 6e-4);
    EXPECT_NEAR(WeakFurnaceSphere(leaning, {Masking::kVCavity}, FromSpherical(theta[i], 0.6)), v_cavity[i], 6e-5);
    EXPECT_NEAR(WeakFurnaceSphere(ggx, {Masking::kVCavity}, wo), 1, 1e-8);  // the kink at G1 = 1 costs digits
  }
}

// Smith masking closes the furnace on the sphere: by quadrature, not by the closed form that the function uses.
TEST(WeakFurnace, SmithIsExactOnTheSphere) {
  ShapeGenerator random(71);
  for (int i = 0; i < 20; ++i) {
    const Ellipsoid e = i % 2 == 0 ? random.Moderate()
                                   : Ellipsoid{random.LogUniform(1e-3, 1), random.LogUniform(1e-3, 1), 0.3, -0.9, 1};
    const EllipsoidDistribution distribution(e);
    const Vec3 wo = random.Upper();
    const double no_fresnel = MeanVisibleFresnel(distribution, kPerfect, wo);
    EXPECT_NEAR(no_fresnel, 1, 1e-9);
    const double W = WeakFurnaceSphere(distribution, {}, wo);
    EXPECT_LE(W, 1);
    EXPECT_EQ(WeakFurnaceSphere(distribution, {Masking::kSmithUnclamped}, wo), 1);
    const double up = WeakFurnaceHemisphere(distribution, {}, wo),
                 diffuse_up = WeakFurnaceDiffuseHemisphere(distribution, {}, wo);
    EXPECT_GT(up, 0);
    EXPECT_LE(up, W * (1 + 1e-9));
    EXPECT_LE(diffuse_up, W * (1 + 1e-9));
    EXPECT_GE(diffuse_up, 0.5 * W);
  }
}

// A smooth surface loses nothing; missing energy grows with roughness; more correlation loses less.
TEST(EnergyMissing, GrowsWithRoughnessAndFallsWithCorrelation) {
  double previous = 0;
  for (const double alpha : {1e-3, 0.1, 0.3, 0.6, 1.0}) {
    const EllipsoidDistribution distribution({alpha, alpha, 0, 0, 0});
    const double missing = EnergyMissing(distribution, {}, AtAngle(0.7), nullptr, 1e-9);
    EXPECT_GT(missing, previous);
    EXPECT_LT(missing, alpha == 1e-3 ? 1e-4 : 1.0);
    previous = missing;
    double last = missing;
    for (const Masking kind : {Masking::kSmithHeight, Masking::kSmithHeightDirection}) {
      const double less = EnergyMissing(distribution, {kind}, AtAngle(0.7), nullptr, 1e-9);
      EXPECT_LT(less, last);
      EXPECT_GE(less, 0);
      last = less;
    }
  }
}

// Gradients against fourth-order differences with a step of 0.01: truncation 1e-6; the quadrature's 1e-8 leaves as
// much.
template <class F>
void ExpectGradientOf(const SlopeDistribution& s, const F& f, int count = 5) {
  double gradient[5];
  f(s, gradient);
  double largest = 0;
  for (const double d : gradient) largest = std::fmax(largest, std::abs(d));
  for (int k = 0; k < count; ++k) {
    const double h = 1e-2;
    const auto moved = [&](double step) {
      SlopeDistribution t = s;
      (k == 0 ? t.alpha_x : k == 1 ? t.alpha_y : k == 2 ? t.r : k == 3 ? t.slope_x : t.slope_y) += step;
      return f(t, nullptr);
    };
    const double difference = (8 * (moved(h) - moved(-h)) - (moved(2 * h) - moved(-2 * h))) / (12 * h);
    EXPECT_NEAR(gradient[k], difference, 2e-5 * largest) << k;
  }
}

TEST(Energy, Gradients) {
  const Vec3 wo = FromSpherical(0.8, 0.4);
  const FresnelOfCosine fresnel = [](double c) { return FresnelConductor(c, {0.9, 2.5}); };
  // Centred, without the mean slope: nothing is clamped, no kink slows the quadrature.
  ExpectGradientOf(
      SlopeDistribution{Family::kGgx, 0.35, 0.5, 0.2, 0, 0},
      [&](const SlopeDistribution& t, double* gradient) {
        return DirectionalAlbedo(SlopeNormalDistribution(t), {Masking::kSmithHeight}, fresnel, wo, gradient, 1e-8);
      },
      3);
  for (const Family kind : {Family::kGgx, Family::kBeckmann}) {
    const SlopeDistribution s = {kind, 0.35, 0.5, 0.2, 0.15, -0.1};
    ExpectGradientOf(s, [&](const SlopeDistribution& t, double* gradient) {
      return MeanVisibleFresnel(SlopeNormalDistribution(t), fresnel, wo, gradient, 1e-8);
    });
    ExpectGradientOf(s, [&](const SlopeDistribution& t, double* gradient) {
      return WeakFurnaceDiffuseHemisphere(SlopeNormalDistribution(t), {}, wo, gradient, 1e-8);
    });
  }
}

// The albedo is the integral of the BRDF over reflected directions: an independent product rule in wi.
TEST(DirectionalAlbedo, IsTheIntegralOfTheBrdf) {
  const QuadratureRule rule = GaussLegendre(120);
  const EllipsoidDistribution distribution({0.5, 0.35, 0, 0, 0.4});
  const FresnelOfCosine fresnel = [](double c) { return FresnelSchlick(c, 0.6); };
  const Vec3 wo = FromSpherical(0.7, 0.3);
  for (const Masking kind : {Masking::kSmithSeparable, Masking::kSmithHeight}) {
    double sum = 0;
    const int azimuths = 240;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double theta = 0.25 * kPi * (1 + rule.nodes[i]);
      for (int j = 0; j < azimuths; ++j) {
        const Vec3 wi = FromSpherical(theta, 2 * kPi * j / azimuths);
        double cos_d;
        const double f = MicrofacetSpecular(distribution, {kind}, wo, wi, nullptr, &cos_d);
        sum += 0.25 * kPi * rule.weights[i] * 2 * kPi / azimuths * std::sin(theta) * f * fresnel(cos_d) * wi.z;
      }
    }
    EXPECT_NEAR(DirectionalAlbedo(distribution, {kind}, fresnel, wo), sum, 1e-8);
  }
}

}  // namespace
}  // namespace lobefit
