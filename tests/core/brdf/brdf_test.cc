#include "lobefit/core/brdf/brdf.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/support/shapes.h"
#include <gtest/gtest.h>

#include "lobefit/core/microfacet/ellipsoid_brdf.h"
#include "lobefit/core/microfacet/energy.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

Model TwoLobes() {
  Model model;
  model.lobes.resize(2);
  model.lobes[1].masking = Masking::kSmithHeight;
  model.lobes[1].fresnel = Fresnel::kNone;
  return model;
}

// Two channels.
const ParameterValues kTwoLobes = {{0.2}, {0.35}, {0.1},  {-0.2}, {0.4},      {0.04, 0.7}, {0.5},
                                   {0.6}, {0.05}, {0.02}, {-1},   {0.1, 0.3}, {0.2, 0.05}};

Model OneLobe(Diffuse diffuse) {
  Model model;
  model.lobes.resize(1);
  model.diffuse = diffuse;
  return model;
}

TEST(Reflectance, ArraysHaveTheBitsOfOneSample) {
  const Reflectance reflectance(TwoLobes(), kTwoLobes, 2);
  ShapeGenerator random(3);
  std::vector<double> v[6];
  constexpr std::size_t kCount = 203;
  std::vector<Vec3> wi, wo;
  for (std::size_t k = 0; k < kCount; ++k) {
    wi.push_back(random.Upper());
    wo.push_back(k % 7 == 0 ? wi.back() : random.Upper());
    const double all[6] = {wi[k].x, wi[k].y, wi[k].z, wo[k].x, wo[k].y, wo[k].z};
    for (int j = 0; j < 6; ++j) v[j].push_back(all[j]);
  }
  std::vector<std::vector<double>> f_r;
  reflectance.Evaluate({v[0].data(), v[1].data(), v[2].data(), v[3].data(), v[4].data(), v[5].data(), kCount}, &f_r);
  ASSERT_EQ(f_r.size(), 2U);
  for (std::size_t k = 0; k < kCount; ++k) {
    double one[2];
    reflectance.Evaluate(wi[k], wo[k], one);
    EXPECT_EQ(one[0], f_r[0][k]);
    EXPECT_EQ(one[1], f_r[1][k]);
  }
}

// Against the other path through the ellipsoid's own formulas.
TEST(Reflectance, IsTheSumOfItsParts) {
  ShapeGenerator random(4);
  for (int trial = 0; trial < 500; ++trial) {
    const Ellipsoid e = random.Moderate();
    const double f0 = random.Uniform(0, 1), albedo = random.Uniform(0, 1);
    const Reflectance reflectance(OneLobe(Diffuse::kLambert),
                                  {{e.alpha_x}, {e.alpha_y}, {e.theta_x}, {e.theta_y}, {e.theta_z}, {f0}, {albedo}}, 1);
    const Vec3 wi = random.Upper(), wo = random.Upper();
    double f_r = 0;
    reflectance.Evaluate(wi, wo, &f_r);
    const double expected = EllipsoidSchlickBrdf(e, f0, wo, wi, Masking::kSmithSeparable) + LambertBrdf(albedo, wo, wi);
    EXPECT_NEAR(f_r, expected, 1e-10 * expected);
  }
}

TEST(Reflectance, IsReciprocal) {
  const Reflectance reflectance(TwoLobes(), kTwoLobes, 2);
  ShapeGenerator random(5);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 wi = random.Upper(), wo = random.Upper();
    double there[2], back[2];
    reflectance.Evaluate(wi, wo, there);
    reflectance.Evaluate(wo, wi, back);
    for (int c = 0; c < 2; ++c) EXPECT_NEAR(there[c], back[c], 1e-13 * there[c]);
  }
}

TEST(Reflectance, IsZeroAtAndBelowTheHorizon) {
  const Reflectance reflectance(TwoLobes(), kTwoLobes, 2);
  const Vec3 up = {0, 0.6, 0.8};
  for (const Vec3& low : {Vec3{0.6, 0, -0.8}, Vec3{1, 0, 0}}) {
    double f_r[2] = {1, 1};
    reflectance.Evaluate(up, low, f_r);
    EXPECT_EQ(f_r[0] + f_r[1], 0);
    f_r[0] = f_r[1] = 1;
    reflectance.Evaluate(low, up, f_r);
    EXPECT_EQ(f_r[0] + f_r[1], 0);
  }
}

// Albedo over the hemisphere by a product rule in the polar angle and azimuth.
double Albedo(const Reflectance& reflectance, const Vec3& wo) {
  const QuadratureRule rule = GaussLegendre(64);
  double sum = 0;
  constexpr int kAzimuths = 128;
  for (int j = 0; j < kAzimuths; ++j) {
    const double phi = 2 * kPi * j / kAzimuths;
    sum += Integrate(rule, 0, 0.5 * kPi, [&](double theta) {
      const Vec3 wi = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
      double f_r = 0;
      reflectance.Evaluate(wi, wo, &f_r);
      return f_r * wi.z * std::sin(theta);
    });
  }
  return sum * 2 * kPi / kAzimuths;
}

// White furnace: F = 1 and no diffuse part reflect at most all of the light, and the smoother the surface the nearer to
// all of it, as the integral over micro normals says; a Lambert part reflects its albedo exactly.
TEST(Reflectance, WhiteFurnace) {
  const auto specular = [](double alpha) {
    return Reflectance(OneLobe(Diffuse::kNone), {{alpha}, {alpha}, {0.0}, {0.0}, {0.0}, {1.0}}, 1);
  };
  for (const double theta : {0.2, 0.8, 1.3}) {
    const Vec3 wo = {std::sin(theta), 0, std::cos(theta)};
    const double rough = Albedo(specular(0.9), wo), smooth = Albedo(specular(0.3), wo);
    EXPECT_LT(rough, smooth);
    EXPECT_LE(smooth, 1);
    const double other_way = DirectionalAlbedo(
        EllipsoidDistribution({0.3, 0.3, 0, 0, 0}), Shadowing{}, [](double) { return 1.0; }, wo);
    EXPECT_NEAR(smooth, other_way, 1e-6);
    const Reflectance lambert(OneLobe(Diffuse::kLambert), {{0.5}, {0.5}, {0.0}, {0.0}, {0.0}, {0.0}, {0.37}}, 1);
    EXPECT_GT(Albedo(lambert, wo), 0.37);
  }
  Model matte;
  const Reflectance only_lambert(matte, {{0.37}}, 1);
  EXPECT_NEAR(Albedo(only_lambert, {0, 0, 1}), 0.37, 1e-13);
}

TEST(Reflectance, RefusesWhatDoesNotFit) {
  ParameterValues few = kTwoLobes;
  few.pop_back();
  EXPECT_THROW(Reflectance(TwoLobes(), few, 2), std::invalid_argument);
  EXPECT_THROW(Reflectance(TwoLobes(), kTwoLobes, 3), std::invalid_argument);
}

}  // namespace
}  // namespace lobefit
