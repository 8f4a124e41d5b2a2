#include "lobefit/core/microfacet/energy_compensation.h"

#include <gtest/gtest.h>

#include "lobefit/core/fresnel/fresnel.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

const FresnelOfCosine kMirror = [](double) { return 1.0; };

// [Heitz eq 103] for F = 1: what the two parts send up is everything that came in.
TEST(EnergyCompensation, ClosesTheWhiteFurnace) {
  const EllipsoidDistribution distribution({0.6, 0.4, 0, 0, 0.5});
  const EnergyCompensation compensation(distribution, {Masking::kSmithHeight}, kMirror, 1e-6);
  EXPECT_GT(compensation.mean_missing(), 0.01);
  const Vec3 wo = FromSpherical(0.8, 0.3);
  const double first = DirectionalAlbedo(distribution, {Masking::kSmithHeight}, kMirror, wo, nullptr, 1e-6);
  // Another rule than the one that made the average.
  const QuadratureRule rule = GaussLegendre(14);
  double multiple = 0;
  const int azimuths = 10;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double theta = 0.25 * kPi * (1 + rule.nodes[i]);
    for (int j = 0; j < azimuths; ++j) {
      const Vec3 wi = FromSpherical(theta, 2 * kPi * j / azimuths);
      multiple += 0.25 * kPi * rule.weights[i] * 2 * kPi / azimuths * std::sin(theta) * wi.z *
                  compensation.MultipleScattering(wo, wi);
    }
  }
  EXPECT_NEAR(first + multiple, 1, 2e-6);
}

TEST(EnergyCompensation, ReciprocalAndNeverLess) {
  const EllipsoidDistribution distribution({0.6, 0.4, 0, 0, 0.5});
  const FresnelOfCosine fresnel = [](double c) { return FresnelSchlick(c, 0.5); };
  const EnergyCompensation compensation(distribution, {}, fresnel, 1e-6, 8);
  const Vec3 wo = FromSpherical(0.8, 0.3), wi = FromSpherical(0.4, 2.0);
  const double f = compensation.Brdf(wo, wi);
  EXPECT_NEAR(compensation.Brdf(wi, wo), f, 1e-13 * f);
  double cos_d;
  const double specular = MicrofacetSpecular(distribution, {}, wo, wi, nullptr, &cos_d);
  EXPECT_GT(f, fresnel(cos_d) * specular);
  EXPECT_EQ(compensation.Brdf(wo, -wi), 0);
}

TEST(EnergyCompensation, Gradient) {
  const FresnelOfCosine fresnel = [](double c) { return FresnelSchlick(c, 0.5); };
  const Vec3 wo = FromSpherical(0.8, 0.3), wi = FromSpherical(0.4, 2.0);
  const auto evaluate = [&](double alpha_x, double theta_z, double* gradient) {
    const EllipsoidDistribution distribution({alpha_x, 0.4, 0, 0, theta_z});
    return EnergyCompensation(distribution, {}, fresnel, 1e-8, 6).Brdf(wo, wi, gradient);
  };
  double gradient[5];
  evaluate(0.6, 0.5, gradient);
  const double h = 1e-3;
  EXPECT_NEAR(gradient[0], (evaluate(0.6 + h, 0.5, nullptr) - evaluate(0.6 - h, 0.5, nullptr)) / (2 * h), 1e-5);
  EXPECT_NEAR(gradient[4], (evaluate(0.6, 0.5 + h, nullptr) - evaluate(0.6, 0.5 - h, nullptr)) / (2 * h), 1e-5);
}

}  // namespace
}  // namespace lobefit
