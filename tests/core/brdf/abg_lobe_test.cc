#include "lobefit/core/brdf/abg_lobe.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/core/brdf/model_energy.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

Vec3 Toward(double degrees, double azimuth) { return FromSpherical(DegreesToRadians(degrees), azimuth); }

// The formula as stray-light programs have it, in direction cosines.
double Published(double A, double B, double g, const Vec3& wi, const Vec3& wo) {
  const double x = wo.x + wi.x, y = wo.y + wi.y;  // beta - beta_0, with beta_0 the mirror direction
  return A / (B + std::pow(std::hypot(x, y), g));
}

TEST(AbgLobe, IsThePublishedFormula) {
  for (const double g : {0.7, 1.6, 2.0, 3.4}) {
    const double A = 2e-4, B = 1e-5, alpha = std::pow(B, 1 / g) / 2, scale = A / B * 4 * kPi * alpha * alpha;
    const Model model = {{{Ndf::kAbg, Masking::kNone, Fresnel::kNone}}, Diffuse::kNone};
    const Reflectance reflectance(model, {{alpha}, {alpha}, {0}, {0}, {0}, {g}, {scale}}, 1);
    for (const double theta_i : {0., 5., 30., 75.}) {
      for (const double off : {0., 0.01, 1., 20., 80.}) {
        const Vec3 wi = Toward(theta_i, 0.3), wo = Toward(std::fabs(theta_i - off), 0.3 + kPi - 0.01 * off);
        double f_r = 0;
        reflectance.Evaluate(wi, wo, &f_r);
        // Near the mirror direction the difference of direction cosines has lost digits.
        const double expected = Published(A, B, g, wi, wo);
        EXPECT_NEAR(f_r / expected, 1, 1e-9) << g << " " << theta_i << " " << off;
      }
    }
  }
}

// At the mirror direction it is as high as a GGX lobe of the same widths and reflectance, but for its masking and
// cosines, which are 1 at normal incidence.
TEST(AbgLobe, HasThePeakOfGgx) {
  const ParameterValues values = {{0.05}, {0.02}, {0}, {0}, {0.7}, {2.2}, {0.6}};
  const Reflectance abg({{{Ndf::kAbgAnisotropic, Masking::kNone, Fresnel::kNone}}, Diffuse::kNone}, values, 1);
  const Reflectance ggx({{{Ndf::kGgxAnisotropic, Masking::kSmithSeparable, Fresnel::kNone}}, Diffuse::kNone},
                        {{0.05}, {0.02}, {0}, {0}, {0.7}, {0.6}}, 1);
  const Vec3 n = {0, 0, 1};
  double a = 0, b = 0;
  abg.Evaluate(n, n, &a);
  ggx.Evaluate(n, n, &b);
  EXPECT_NEAR(a, b, 1e-12 * b);
}

// Brute force over the hemisphere in polar coordinates about the mirror direction, by adaptive quadrature.
double AlbedoByForce(const Model& model, const ParameterValues& values, const Vec3& wi) {
  const Reflectance reflectance(model, values, 1);
  QuadratureOptions options;
  options.relative = 1e-9;
  options.max_intervals = 4000;
  const double d = std::hypot(wi.x, wi.y), at = std::atan2(-wi.y, -wi.x);
  const auto ray = [&](double phi) {
    const double across = d * std::sin(phi), reach = -d * std::cos(phi) + std::sqrt(std::max(0.0, 1 - across * across));
    // In the logarithm of the distance.
    const auto inner = IntegrateAdaptive<1>(
        [&](double t) {
          const double r = std::exp(t), x = -wi.x + r * std::cos(phi + at), y = -wi.y + r * std::sin(phi + at);
          const double z2 = 1 - x * x - y * y;
          double f = 0;
          if (z2 > 0) reflectance.Evaluate(wi, {x, y, std::sqrt(z2)}, &f);
          return std::array<double, 1>{f * r * r};
        },
        {std::log(1e-9), std::log(reach)}, options);
    return inner.value[0];
  };
  return IntegrateAdaptive<1>([&](double phi) { return std::array<double, 1>{ray(phi)}; }, {-kPi, 0, kPi}, options)
      .value[0];
}

TEST(AbgLobe, AlbedoIsTheIntegralOverTheHemisphere) {
  const struct {
    double alpha_x, alpha_y, theta_z, g;
  } shapes[] = {{0.0004, 0.0004, 0, 1.6}, {0.05, 0.05, 0, 0.7}, {0.02, 0.005, 0.6, 2.5}, {0.3, 0.3, 0, 8}};
  for (const auto& s : shapes) {
    const Model model = {{{Ndf::kAbgAnisotropic, Masking::kNone, Fresnel::kNone}}, Diffuse::kNone};
    const ParameterValues values = {{s.alpha_x}, {s.alpha_y}, {0}, {0}, {s.theta_z}, {s.g}, {1}};
    for (const double theta_i : {0., 30., 80.}) {
      const Vec3 wi = Toward(theta_i, 0.4);
      const double expected = AlbedoByForce(model, values, wi);
      EXPECT_NEAR(DirectionalAlbedo(model, values, 1, wi)[0] / expected, 1, 1e-5) << s.g << " " << theta_i;
    }
  }
}

TEST(AbgLobe, DistributionHasItsShapeAndThePlanesArea) {
  const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid({0.2, 0.1, 0, 0, 0.5});
  const AbgDistribution distribution(shape, 1.7);
  const Vec3 m = Toward(12, 1.1);
  double specular = 0, cos_d = 0;
  AbgLobe({&m.x, &m.y, &m.z, &m.x, &m.y, &m.z, 1}, shape, 1.7, &specular, &cos_d, nullptr);
  EXPECT_DOUBLE_EQ(distribution.D(m), 4 * specular);
  EXPECT_DOUBLE_EQ(distribution.Sigma(m), m.z);
  EXPECT_EQ(distribution.Sigma({0, 0, -1}), 0);
  EXPECT_EQ(distribution.D({0.6, 0, -0.8}), 0);
}

}  // namespace
}  // namespace lobefit
