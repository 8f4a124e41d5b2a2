#include <cmath>

#include "tests/report/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/core/brdf/model_energy.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

TEST(DirectionalAlbedo, IsTheIntegralOfTheReflectance) {
  for (const bool isotropic : {true, false}) {
    const Material material = test::MakeMaterial(3, isotropic);
    const Reflectance reflectance(material.model, material.Values(), 3);
    const QuadratureRule rule = GaussLegendre(160);
    for (const double theta : {0.0, 30.0, 65.0}) {
      const Vec3 wi = test::AtDegrees(theta, 25);
      std::vector<double> f_r(3);
      const double expected = Integrate(rule, 0, kPi / 2, [&](double t) {
        return std::sin(t) * std::cos(t) * Integrate(rule, 0, 2 * kPi, [&](double p) {
                 reflectance.Evaluate(wi, FromSpherical(t, p), f_r.data());
                 return f_r[1];
               });
      });
      const double albedo = DirectionalAlbedo(material.model, material.Values(), 3, wi)[1];
      EXPECT_NEAR(albedo, expected, 0.004 * expected) << theta << (isotropic ? " isotropic" : " ellipsoid");
    }
  }
}

TEST(SingleBounceAlbedo, NeverExceedsOneForAClampedMasking) {
  const Material material = test::MakeMaterial(1, false);
  for (int theta = 0; theta < 89; theta += 8) {
    for (int phi = 0; phi < 360; phi += 45) {
      EXPECT_LE(SingleBounceAlbedo(material.model, material.Values(), 0, test::AtDegrees(theta, phi)), 1.002)
          << theta << " " << phi;
    }
  }
}

TEST(WeakFurnace, IsOneForACentredLobeAndLessWhereTheClampActs) {
  const Material centred = test::MakeMaterial(1, true);
  EXPECT_NEAR(WeakFurnace(centred.model, centred.Values(), 0, test::AtDegrees(50, 0)), 1, 1e-12);
  Material tilted = test::MakeMaterial(1, false);
  tilted.parameters[3].values = {0.3};
  double least = 1;
  for (int phi = 0; phi < 360; phi += 15)
    least = std::min(least, WeakFurnace(tilted.model, tilted.Values(), 0, test::AtDegrees(40, phi)));
  EXPECT_LT(least, 0.95);
  tilted.model.lobes[0].masking = Masking::kSmithUnclamped;
  EXPECT_EQ(WeakFurnace(tilted.model, tilted.Values(), 0, test::AtDegrees(40, 0)), 1);
}

}  // namespace
}  // namespace lobefit
