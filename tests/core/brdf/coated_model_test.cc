// Whole models below a coat, as they are fitted and drawn.
#include <algorithm>
#include <cmath>

#include "tests/support/reference_table.h"
#include "tests/support/shapes.h"
#include <gtest/gtest.h>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/core/brdf/coat.h"
#include "lobefit/core/brdf/diffuse.h"
#include "lobefit/core/brdf/model_energy.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

Model Coated(Ndf ndf, Fresnel coat) {
  return {{{Ndf::kGgx, Masking::kSmithSeparable, coat}, {ndf, Masking::kSmithSeparable}}, Diffuse::kLambert};
}

constexpr Fresnel kCoats[] = {Fresnel::kCoatLayered, Fresnel::kCoatRefracted};

// Two channels.
ParameterValues Values(double coat_alpha, double ior, double tau) {
  return {{coat_alpha}, {coat_alpha}, {0}, {0}, {0}, {ior, ior}, {tau, 2 * tau},
          {0.3},        {0.15},       {0}, {0}, {0}, {0.4, 0.9}, {0.5, 0.1}};
}

// The 60-digit table of the formula, evaluated as a model that a fit may have.
TEST(CoatedModel, IsTheFormulaOfTheTable) {
  const ReferenceTable table("coat_brdf");
  std::size_t compared = 0;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const auto at = [&](const char* name) { return table(row, name); };
    const double r = at("r");
    SlopeCoordinates slope;
    slope.v[0] = at("slope_x");
    slope.v[1] = at("slope_y");
    slope.v[2] = std::log(at("alpha_x"));
    slope.v[3] = r * at("alpha_y");
    slope.v[4] = std::log(at("alpha_y") * std::sqrt((1 - r) * (1 + r)));
    const Ellipsoid e = EllipsoidFromSlopeCoordinates(slope);
    const Vec3 wi = {at("ix"), at("iy"), at("iz")}, wo = {at("ox"), at("oy"), at("oz")};
    const double ior = at("ior"), tau = at("tau"), alpha = at("coat_alpha");
    for (const Fresnel coat : kCoats) {
      const bool refracted = coat == Fresnel::kCoatRefracted;
      const double albedo = refracted ? ApparentAlbedo(at("albedo"), ior) : at("albedo");
      const ParameterValues values = {{alpha},     {alpha},     {0},         {0},         {0},
                                      {ior},       {tau},       {e.alpha_x}, {e.alpha_y}, {e.theta_x},
                                      {e.theta_y}, {e.theta_z}, {at("f0")},  {albedo}};
      double f;
      Reflectance(Coated(Ndf::kEllipsoid, coat), values, 1).Evaluate(wi, wo, &f);
      const double expected = at(refracted ? "f_refracted" : "f_layered"),
                   cond = at(refracted ? "cond_refracted" : "cond_layered");
      // The ellipsoid's angles cost digits on the way from slopes.
      EXPECT_NEAR(f, expected, 1e-9 * expected * std::max(1.0, cond)) << row;
      ++compared;
    }
  }
  EXPECT_GE(compared, 100U);
}

TEST(CoatedModel, ArraysHaveTheBitsOfOneSampleAndTheOrderOfLobesIsFree) {
  for (const Fresnel coat : kCoats) {
    const Model model = Coated(Ndf::kGgxAnisotropic, coat);
    const ParameterValues values = Values(0.1, 1.5, 0.3);
    Model swapped = model;
    std::swap(swapped.lobes[0], swapped.lobes[1]);
    ParameterValues other = values;
    std::rotate(other.begin(), other.begin() + 7, other.begin() + 13);
    const Reflectance reflectance(model, values, 2), reordered(swapped, other, 2);
    ShapeGenerator random(5);
    std::vector<double> v[6];
    constexpr std::size_t kCount = 67;
    for (std::size_t k = 0; k < kCount; ++k) {
      const Vec3 wi = random.Upper(), wo = random.Upper();
      const double all[6] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
      for (int j = 0; j < 6; ++j) v[j].push_back(all[j]);
    }
    std::vector<std::vector<double>> f;
    reflectance.Evaluate({v[0].data(), v[1].data(), v[2].data(), v[3].data(), v[4].data(), v[5].data(), kCount}, &f);
    for (std::size_t k = 0; k < kCount; ++k) {
      const Vec3 wi = {v[0][k], v[1][k], v[2][k]}, wo = {v[3][k], v[4][k], v[5][k]};
      double one[2], back[2], same[2];
      reflectance.Evaluate(wi, wo, one);
      reflectance.Evaluate(wo, wi, back);
      reordered.Evaluate(wi, wo, same);
      for (int c = 0; c < 2; ++c) {
        EXPECT_EQ(one[c], f[static_cast<std::size_t>(c)][k]);
        EXPECT_EQ(one[c], same[c]);
        EXPECT_NEAR(back[c], one[c], 1e-12 * one[c]);
      }
    }
  }
}

// By a product rule over the hemisphere that knows nothing of lobes.
TEST(CoatedModel, AlbedoIsTheIntegralAndNoEnergyIsMade) {
  const QuadratureRule rule = GaussLegendre(80);
  for (const Fresnel coat : kCoats) {
    const Model model = Coated(Ndf::kGgxAnisotropic, coat);
    for (const double theta : {0.2, 0.9, 1.3}) {
      const Vec3 wi = FromSpherical(theta, 0.4);
      const ParameterValues values = Values(0.4, 1.5, 0.2);
      const Reflectance reflectance(model, values, 2);
      double sum[2] = {0, 0};
      const int azimuths = 160;
      for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        const double t = 0.25 * kPi * (1 + rule.nodes[i]);
        for (int j = 0; j < azimuths; ++j) {
          double f[2];
          reflectance.Evaluate(wi, FromSpherical(t, 2 * kPi * (j + 0.5) / azimuths), f);
          for (int c = 0; c < 2; ++c)
            sum[c] += 0.25 * kPi * rule.weights[i] * 2 * kPi / azimuths * std::sin(t) * std::cos(t) * f[c];
        }
      }
      const std::vector<double> albedo = DirectionalAlbedo(model, values, 2, wi);
      for (int c = 0; c < 2; ++c) EXPECT_NEAR(albedo[static_cast<std::size_t>(c)], sum[c], 4e-3 * sum[c]) << theta;
    }
    // A white mirror-like base below a clear coat: MATH.md 8.6 states .94 and .96 at the normal.
    ParameterValues white = Values(0.05, 1.5, 0);
    white[7] = white[8] = {0.05};
    white[12] = {1, 1};
    white[13] = {0, 0};
    const double expected = coat == Fresnel::kCoatRefracted ? 0.94 : 0.96;
    EXPECT_NEAR(DirectionalAlbedo(model, white, 2, {0, 0, 1})[0], expected, 0.006);
    // And a white Lambertian one below a smooth coat reflects all that enters. (A rough one reflects a little more than
    // T leaves for it: 2e-4 at 80 degrees with alpha 0.05.)
    white[0] = white[1] = {0.002};
    white[12] = {0, 0};
    white[13] = {1, 1};
    for (const double theta : {0.1, 1.0, 1.4})
      EXPECT_LE(DirectionalAlbedo({{model.lobes[0]}, Diffuse::kLambert},
                                  {white[0], white[1], white[2], white[3], white[4], white[5], white[6], white[13]}, 2,
                                  FromSpherical(theta, 0))[0],
                1 + 1e-5);
  }
}

}  // namespace
}  // namespace lobefit
