#include "lobefit/core/microfacet/microfacet.h"

#include "tests/support/shapes.h"
#include <gtest/gtest.h>

#include "lobefit/core/microfacet/diffuse_microfacets.h"
#include "lobefit/core/microfacet/ellipsoid_brdf.h"
#include "lobefit/core/microfacet/energy.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

const Masking kAllKinds[] = {Masking::kSmithSeparable, Masking::kSmithUnclamped,       Masking::kSmithHeight,
                             Masking::kSmithDirection, Masking::kSmithHeightDirection, Masking::kVCavity,
                             Masking::kImplicit,       Masking::kSchlickSmith,         Masking::kKelemen};

// With separable masking the general BRDF is [Walter eq 4-6], clamped and not, value and gradient.
TEST(Microfacet, EqualsTheEllipsoidBrdf) {
  ShapeGenerator random(81);
  for (int i = 0; i < 500; ++i) {
    const Ellipsoid e = random.Moderate();
    const EllipsoidDistribution distribution(e);
    const Vec3 wo = random.Upper(), wi = random.Upper();
    for (const Masking kind : {Masking::kSmithSeparable, Masking::kSmithUnclamped}) {
      double expected[6], gradient[5], cos_d;
      BrdfFactors factors;
      EllipsoidSchlickBrdf(e, 0.5, wo, wi, kind, expected, &factors);
      const double f = EllipsoidSchlickBrdf(e, 0.5, wo, wi, kind) / factors.F;
      const Shadowing shadowing = {kind};
      EXPECT_NEAR(MicrofacetSpecular(distribution, shadowing, wo, wi, gradient, &cos_d), f, 1e-12 * f);
      for (double& d : expected) d /= factors.F;
      ExpectSameGradient(gradient, expected, 5, 1e-9, f);
      EXPECT_NEAR(FresnelSchlick(cos_d, 0.5), factors.F, 1e-14);
    }
  }
}

TEST(Microfacet, ReciprocalForEveryMasking) {
  ShapeGenerator random(82);
  for (int i = 0; i < 200; ++i) {
    const SlopeNormalDistribution distribution({i % 2 == 0 ? Family::kGgx : Family::kBeckmann,
                                                random.LogUniform(0.05, 1), random.LogUniform(0.05, 1), 0.3, 0.2,
                                                -0.1});
    const Vec3 wo = random.Upper(), wi = random.Upper();
    for (const Masking kind : kAllKinds) {
      const Shadowing shadowing = {kind, 0.3};
      double a[5], b[5];
      EXPECT_EQ(MicrofacetSpecular(distribution, shadowing, wo, wi, a),
                MicrofacetSpecular(distribution, shadowing, wi, wo, b));
      for (int k = 0; k < 5; ++k) EXPECT_EQ(a[k], b[k]);
      EXPECT_EQ(MicrofacetSpecular(distribution, shadowing, wo, wi),
                MicrofacetSpecular(distribution, shadowing, wo, wi, a));
      EXPECT_EQ(MicrofacetSpecular(distribution, shadowing, wo, -wi), 0);
    }
  }
}

TEST(Microfacet, GradientsOfEveryMasking) {
  const Vec3 wo = FromSpherical(0.9, 0.3), wi = FromSpherical(0.6, 2.5);
  const SlopeDistribution s = {Family::kBeckmann, 0.4, 0.6, 0.2, 0.1, -0.2};
  for (const Masking kind : kAllKinds) {
    const Shadowing shadowing = {kind, 0.3};
    double gradient[5];
    MicrofacetSpecular(SlopeNormalDistribution(s), shadowing, wo, wi, gradient);
    for (int k = 0; k < 5; ++k) {
      const auto moved = [&](double step) {
        SlopeDistribution t = s;
        (k == 0 ? t.alpha_x : k == 1 ? t.alpha_y : k == 2 ? t.r : k == 3 ? t.slope_x : t.slope_y) += step;
        return MicrofacetSpecular(SlopeNormalDistribution(t), shadowing, wo, wi);
      };
      const double h = 1e-5;
      EXPECT_NEAR(gradient[k], (moved(h) - moved(-h)) / (2 * h), 1e-8 * (1 + std::abs(gradient[k]))) << k;
    }
  }
}

TEST(DiffuseMicrofacets, SmoothFacetsAreLambertian) {
  const EllipsoidDistribution distribution({1e-3, 1e-3, 0, 0, 0});
  EXPECT_NEAR(DiffuseMicrofacetBrdf(distribution, {}, FromSpherical(0.5, 0.1), FromSpherical(1.0, 2)), kInvPi,
              1e-3 * kInvPi);
}

TEST(DiffuseMicrofacets, ReciprocalAndStableInTolerance) {
  ShapeGenerator random(83);
  for (int i = 0; i < 15; ++i) {
    const Ellipsoid e = {random.LogUniform(0.01, 1), random.LogUniform(0.01, 1), random.Uniform(-0.5, 0.5),
                         random.Uniform(-0.5, 0.5), random.Uniform(-3, 3)};
    const EllipsoidDistribution distribution(e);
    const Vec3 wo = random.Upper(), wi = random.Upper();
    const double f = DiffuseMicrofacetBrdf(distribution, {}, wo, wi);
    EXPECT_NEAR(DiffuseMicrofacetBrdf(distribution, {}, wi, wo), f, 1e-9 * f);
    EXPECT_NEAR(DiffuseMicrofacetBrdf(distribution, {}, wo, wi, nullptr, 1e-6), f, 1e-5 * f);
    EXPECT_GT(f, 0);
  }
}

// With masking alone the diffuse facets send (1 + m.n) / 2 up: their BRDF with separable masking divided by G1(wi),
// integrated over wi.
TEST(DiffuseMicrofacets, IntegrateToTheFurnace) {
  const EllipsoidDistribution distribution({0.5, 0.35, 0, 0, 0.4});
  const Vec3 wo = FromSpherical(0.7, 0.3);
  const QuadratureRule rule = GaussLegendre(16);
  const int azimuths = 24;
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double theta = 0.25 * kPi * (1 + rule.nodes[i]);
    for (int j = 0; j < azimuths; ++j) {
      const Vec3 wi = FromSpherical(theta, 2 * kPi * j / azimuths);
      const double f =
          DiffuseMicrofacetBrdf(distribution, {}, wo, wi, nullptr, 1e-6) / MaskingG1(distribution, {}, wi, wi);
      sum += 0.25 * kPi * rule.weights[i] * 2 * kPi / azimuths * std::sin(theta) * f * wi.z;
    }
  }
  EXPECT_NEAR(sum, WeakFurnaceDiffuseHemisphere(distribution, {}, wo), 1e-4);
}

TEST(DiffuseMicrofacets, Gradient) {
  const SlopeDistribution s = {Family::kGgx, 0.4, 0.6, 0.2, 0.1, -0.2};
  const Vec3 wo = FromSpherical(0.9, 0.3), wi = FromSpherical(0.6, 2.5);
  const Shadowing shadowing = {Masking::kSmithHeight};
  double gradient[5];
  const double f = DiffuseMicrofacetBrdf(SlopeNormalDistribution(s), shadowing, wo, wi, gradient);
  EXPECT_NEAR(f, DiffuseMicrofacetBrdf(SlopeNormalDistribution(s), shadowing, wo, wi), 1e-9 * f);
  for (int k = 0; k < 5; ++k) {
    const auto moved = [&](double step) {
      SlopeDistribution t = s;
      (k == 0 ? t.alpha_x : k == 1 ? t.alpha_y : k == 2 ? t.r : k == 3 ? t.slope_x : t.slope_y) += step;
      return DiffuseMicrofacetBrdf(SlopeNormalDistribution(t), shadowing, wo, wi, nullptr, 1e-11);
    };
    const double h = 1e-4;
    EXPECT_NEAR(gradient[k], (8 * (moved(h) - moved(-h)) - (moved(2 * h) - moved(-2 * h))) / (12 * h), 1e-7) << k;
  }
}

}  // namespace
}  // namespace lobefit
