#include "lobefit/core/axial/axial_distribution.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lobefit/core/microfacet/energy.h"
#include "lobefit/core/microfacet/microfacet.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

const AxialNdf kAll[] = {{Family::kKagiwadaKalaba, 0.3},     {Family::kKagiwadaKalaba, 0.99},
                         {Family::kSphericalGaussian, 0.15}, {Family::kSphericalGaussian, 0.8},
                         {Family::kBeckmann, 0.4},           {Family::kGgx, 0.25}};

TEST(AxialDistribution, GgxAndBeckmannAreThoseOfSlopeSpace) {
  for (const double alpha : {0.05, 0.4, 1.0}) {
    for (const bool beckmann : {false, true}) {
      const AxialDistribution axial({beckmann ? Family::kBeckmann : Family::kGgx, alpha});
      const SlopeNormalDistribution slopes({beckmann ? Family::kBeckmann : Family::kGgx, alpha, alpha, 0, 0, 0});
      const Vec3 wo = FromSpherical(1.0, 0.2), wi = FromSpherical(0.7, 2.9);
      for (const Masking kind : {Masking::kSmithSeparable, Masking::kSmithHeight}) {
        double g = 0, g_slopes[kSlopeParameters];
        const double f = MicrofacetSpecular(axial, {kind}, wo, wi, &g);
        EXPECT_NEAR(f, MicrofacetSpecular(slopes, {kind}, wo, wi, g_slopes), 1e-13 * f);
        // alpha moves both of the other's alphas.
        EXPECT_NEAR(g, g_slopes[0] + g_slopes[1], 1e-11 * (std::fabs(g) + f));
      }
    }
  }
}

TEST(AxialDistribution, BrdfIsReciprocalAndItsGradientRight) {
  for (const AxialNdf& ndf : kAll) {
    const Vec3 wo = FromSpherical(0.9, 0.3), wi = FromSpherical(1.2, 2.5);
    const Shadowing shadowing;
    double gradient = 0;
    const double f = MicrofacetSpecular(AxialDistribution(ndf), shadowing, wo, wi, &gradient);
    EXPECT_GT(f, 0);
    EXPECT_NEAR(MicrofacetSpecular(AxialDistribution(ndf), shadowing, wi, wo), f, 1e-14 * f);
    const double h = 1e-6 * std::fmin(ndf.parameter, 1 - std::fmin(ndf.parameter, 0.9));
    const double up = MicrofacetSpecular(AxialDistribution({ndf.family, ndf.parameter + h}), shadowing, wo, wi);
    const double down = MicrofacetSpecular(AxialDistribution({ndf.family, ndf.parameter - h}), shadowing, wo, wi);
    EXPECT_NEAR((up - down) / (2 * h), gradient, 1e-6 * (std::fabs(gradient) + f));
  }
}

TEST(AxialDistribution, AlbedoIsBelowOneAndTendsToBeckmann) {
  const FresnelOfCosine white = [](double) { return 1.0; };
  for (const AxialNdf& ndf : kAll) {
    for (const double theta : {0.2, 1.3}) {
      const double albedo =
          DirectionalAlbedo(AxialDistribution(ndf), {}, white, FromSpherical(theta, 0), nullptr, 1e-6);
      EXPECT_GT(albedo, 0.02);
      EXPECT_LT(albedo, 1);
    }
  }
  const Vec3 wo = FromSpherical(1.0, 0);
  const double gaussian =
      DirectionalAlbedo(AxialDistribution({Family::kSphericalGaussian, 0.02}), {}, white, wo, nullptr, 1e-6);
  const double beckmann = DirectionalAlbedo(AxialDistribution({Family::kBeckmann, 0.02}), {}, white, wo, nullptr, 1e-6);
  EXPECT_NEAR(gaussian, beckmann, 1e-3);
}

TEST(AxialDistribution, BelowTheHorizonDIsZeroAndSigmaIsNot) {
  const AxialDistribution gaussian({Family::kSphericalGaussian, 1.0});
  double gradient = 1;
  EXPECT_EQ(gaussian.D(FromSpherical(1.8, 0), &gradient), 0);
  EXPECT_EQ(gradient, 0);
  EXPECT_GT(gaussian.Sigma(FromSpherical(2.8, 0)), 0);
  EXPECT_GT(AxialDistribution({Family::kKagiwadaKalaba, 1e-3}).Outline().alpha_x, 0.99);
}

}  // namespace
}  // namespace lobefit
