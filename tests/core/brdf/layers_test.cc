// Diffuse parts, coats and mirrored lobes: laws and gradients. Values: the reference tables.
#include <algorithm>
#include <cmath>

#include "tests/support/differences.h"
#include "tests/support/shapes.h"
#include <gtest/gtest.h>

#include "lobefit/core/brdf/coat.h"
#include "lobefit/core/brdf/diffuse.h"
#include "lobefit/core/fresnel/fresnel.h"
#include "lobefit/core/microfacet/microfacet.h"
#include "lobefit/core/ndf/normal_distribution.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

Vec3 Upper(ShapeGenerator* random) {
  const Vec3 u = random->Sphere();
  return Normalized(Vec3{u.x, u.y, std::abs(u.z) + 0.02});
}

// int f cos_i over the upper hemisphere.
template <class F>
double Albedo(const F& f, int points = 40) {
  const QuadratureRule rule = GaussLegendre(points);
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double theta = 0.25 * kPi * (1 + rule.nodes[i]);
    for (int k = 0; k < 2 * points; ++k) {
      const double phi = kPi * (k + 0.5) / points;
      const Vec3 wi = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
      sum += 0.25 * kPi * rule.weights[i] * kPi / points * wi.z * std::sin(theta) * f(wi);
    }
  }
  return sum;
}

TEST(InterfacedDiffuse, ReflectsWhatEnters) {
  for (const double ior : {1.0, 1.0001, 1.2, 1.5, 2.5}) {
    for (const double cos_o : {1.0, 0.6, 0.1}) {
      for (const double apparent : {1.0, 0.3}) {
        const double albedo =
            Albedo([&](const Vec3& wi) { return InterfacedDiffuse(wi.z, cos_o, ior, apparent); }, 120);
        EXPECT_NEAR(albedo, (1 - FresnelDielectric(cos_o, ior)) * apparent, 3e-6) << ior << " " << cos_o;
      }
    }
  }
  EXPECT_DOUBLE_EQ(InterfacedDiffuse(0.3, 0.7, 1, 0.4), 0.4 * kInvPi);
  EXPECT_EQ(InterfacedDiffuse(0.3, 0.7, 1.5, 0.4), InterfacedDiffuse(0.7, 0.3, 1.5, 0.4));
}

TEST(InterfacedDiffuse, AlbedosGoBothWays) {
  for (const double ior : {1.0, 1.1, 1.5, 2.5}) {
    EXPECT_DOUBLE_EQ(ApparentAlbedo(1, ior), 1);
    EXPECT_EQ(ApparentAlbedo(0, ior), 0);
    for (const double rho : {0.01, 0.3, 0.9}) {
      double drho, dior;
      const double apparent = ApparentAlbedo(rho, ior, &drho, &dior);
      EXPECT_NEAR(AlbedoBelowInterface(apparent, ior), rho, 1e-15);
      EXPECT_NEAR(drho, Difference([&](double x) { return ApparentAlbedo(x, ior); }, rho, 1e-3), 1e-10);
      if (ior > 1.05) {
        EXPECT_NEAR(dior, Difference([&](double x) { return ApparentAlbedo(rho, x); }, ior, 1e-3), 1e-10);
      }
    }
  }
}

TEST(InterfacedDiffuse, GradientsAreDerivatives) {
  const double x[4] = {0.4, 0.7, 1.4, 0.3};
  InterfacedGradient g;
  InterfacedDiffuse(x[0], x[1], x[2], x[3], &g);
  const double gradient[4] = {g.dcos_i, g.dcos_o, g.dior, g.dapparent};
  for (int k = 0; k < 4; ++k) {
    const auto f = [&](double y) {
      double p[4] = {x[0], x[1], x[2], x[3]};
      p[k] = y;
      return InterfacedDiffuse(p[0], p[1], p[2], p[3]);
    };
    EXPECT_NEAR(gradient[k], Difference(f, x[k], 1e-3), 1e-10);
  }
}

TEST(OrenNayar, WhiteFacetsReflectAll) {
  const auto albedo = [](double rho, double roughness, const Vec3& wo) {
    return Albedo(
        [&](const Vec3& wi) {
          const OrenNayar f = OrenNayarDiffuse(rho, roughness, wi, wo);
          return f.single + f.multiple;
        },
        200);
  };
  for (const double roughness : {0.0, 0.4, 1.0}) {
    for (const Vec3& wo : {Vec3{0, 0, 1}, Vec3{0.6, 0, 0.8}, Vec3{0, 0.96, 0.28}}) {
      EXPECT_NEAR(albedo(1, roughness, wo), 1, 2e-4);
      EXPECT_NEAR(OrenNayarAlbedo(1, roughness, wo.z), 1, 1e-15);
      EXPECT_NEAR(albedo(0.4, roughness, wo), OrenNayarAlbedo(0.4, roughness, wo.z), 1e-4);
    }
  }
}

TEST(OrenNayar, SmoothFacetsAreLambert) {
  const OrenNayar f = OrenNayarDiffuse(0.3, 0, {0.6, 0, 0.8}, {0, 0, 1});
  EXPECT_DOUBLE_EQ(f.single, 0.3 * kInvPi);
  EXPECT_EQ(f.multiple, 0);
}

TEST(OrenNayar, GradientsAreDerivativesAndItIsReciprocal) {
  ShapeGenerator random(401);
  for (int i = 0; i < 200; ++i) {
    const Vec3 wi = Upper(&random), wo = Upper(&random);
    const double rho = random.Uniform(0.05, 0.95), roughness = random.Uniform(0.05, 0.95);
    const OrenNayar f = OrenNayarDiffuse(rho, roughness, wi, wo), g = OrenNayarDiffuse(rho, roughness, wo, wi);
    EXPECT_DOUBLE_EQ(f.single, g.single);
    EXPECT_DOUBLE_EQ(f.multiple, g.multiple);
    const auto at = [&](double a, double r) { return OrenNayarDiffuse(a, r, wi, wo); };
    const double h = 1e-2;
    EXPECT_NEAR(f.dsingle_dalbedo, Difference([&](double x) { return at(x, roughness).single; }, rho, h), 1e-9);
    EXPECT_NEAR(f.dmultiple_dalbedo, Difference([&](double x) { return at(x, roughness).multiple; }, rho, h), 1e-9);
    EXPECT_NEAR(f.dsingle_droughness, Difference([&](double x) { return at(rho, x).single; }, roughness, h), 1e-9);
    EXPECT_NEAR(f.dmultiple_droughness, Difference([&](double x) { return at(rho, x).multiple; }, roughness, h), 1e-9);
  }
}

// A Lambertian base below a clear coat, less the coat's own lobe, is the interfaced diffuse part.
TEST(Coat, OverLambertIsInterfaced) {
  ShapeGenerator random(402);
  for (int i = 0; i < 200; ++i) {
    const Vec3 wi = Upper(&random), wo = Upper(&random);
    const double ior = random.Uniform(1.05, 2.5), rho = random.Uniform(0, 1), apparent = ApparentAlbedo(rho, ior);
    const double enters = 1 - DielectricMeanReflectance(ior), expected = InterfacedDiffuse(wi.z, wo.z, ior, apparent);
    const CoatFactors refracted = EvaluateCoat({0.1, ior, 0, true}, wi, wo);
    const double inside = 1 - enters / (ior * ior);  // F_in
    EXPECT_NEAR(refracted.through * rho * kInvPi / (1 - rho * inside), expected, 1e-14);
    const CoatFactors layered = EvaluateCoat({0.1, ior, 0, false}, wi, wo);
    EXPECT_NEAR(layered.through * apparent * kInvPi / enters, expected, 1e-14);
  }
}

TEST(Coat, IsReciprocalAndMakesNoEnergy) {
  ShapeGenerator random(403);
  for (const bool refracted : {false, true}) {
    const Coat coat = {0.15, 1.5, 0.1, refracted};
    const SlopeDistribution base = {Family::kGgx, 0.3, 0.2, 0.2, 0, 0};
    const auto f = [&](const Vec3& wi, const Vec3& wo) {
      const CoatFactors c = EvaluateCoat(coat, wi, wo);
      return c.lobe + c.through * SpecularWithDirections(base, 1, c.inside_i, c.inside_o).value;
    };
    for (int i = 0; i < 100; ++i) {
      const Vec3 wi = Upper(&random), wo = Upper(&random);
      EXPECT_NEAR(f(wi, wo), f(wo, wi), 1e-12 * f(wi, wo));
    }
    for (const double sine : {0.0, 0.6, 0.9}) {
      const Vec3 wo = {sine, 0, std::sqrt(1 - sine * sine)};
      EXPECT_LT(Albedo([&](const Vec3& wi) { return f(wi, wo); }, 100), 1) << sine;
    }
  }
}

TEST(Coat, GradientsAreDerivatives) {
  ShapeGenerator random(404);
  for (int i = 0; i < 60; ++i) {
    const Vec3 wi = Upper(&random), wo = Upper(&random);
    const Coat coat = {random.Uniform(0.1, 0.5), random.Uniform(1.2, 2), random.Uniform(0, 1), i % 2 == 0};
    const CoatFactors f = EvaluateCoat(coat, wi, wo);
    const auto by_ior = [&](auto part) {
      return Difference(
          [&](double x) {
            Coat changed = coat;
            changed.ior = x;
            return part(EvaluateCoat(changed, wi, wo));
          },
          coat.ior, 1e-3);
    };
    EXPECT_NEAR(f.dlobe_dior, by_ior([](const CoatFactors& c) { return c.lobe; }), 1e-8 * (1 + f.lobe));
    EXPECT_NEAR(f.dthrough_dior, by_ior([](const CoatFactors& c) { return c.through; }), 1e-9);
    EXPECT_NEAR(f.dinside_i_dior.x, by_ior([](const CoatFactors& c) { return c.inside_i.x; }), 1e-9);
    EXPECT_NEAR(f.dinside_o_dior.z, by_ior([](const CoatFactors& c) { return c.inside_o.z; }), 1e-9);
    const auto by = [&](double Coat::*member, auto part) {
      return Difference(
          [&](double x) {
            Coat changed = coat;
            changed.*member = x;
            return part(EvaluateCoat(changed, wi, wo));
          },
          coat.*member, 1e-3);
    };
    EXPECT_NEAR(f.dlobe_dalpha, by(&Coat::alpha, [](const CoatFactors& c) { return c.lobe; }), 1e-7 * (1 + f.lobe));
    EXPECT_NEAR(f.dthrough_dtau, by(&Coat::tau, [](const CoatFactors& c) { return c.through; }), 1e-9);
  }
}

TEST(SpecularWithDirections, IsTheMicrofacetLobeAndMovesWithTheDirections) {
  ShapeGenerator random(405);
  for (int i = 0; i < 100; ++i) {
    const SlopeDistribution slopes = {Family::kGgx, 0.4, 0.3, 0.2, 0.1, -0.2};
    const Vec3 wi = Upper(&random), wo = Upper(&random);
    if (std::max(wi.z, wo.z) > 0.95) continue;  // near the normal G1 is cut and not cut within a step
    const DirectionalSpecular f = SpecularWithDirections(slopes, 0.3, wi, wo);
    const SlopeNormalDistribution distribution(slopes);
    double cos_d;
    const double expected = MicrofacetSpecular(distribution, {}, wo, wi, nullptr, &cos_d) * FresnelSchlick(cos_d, 0.3);
    EXPECT_NEAR(f.value, expected, 1e-13 * expected);
    // Turning both directions about an axis keeps them unit vectors.
    const Vec3 axis = random.Sphere();
    const auto turned = [&](double angle) {
      const auto turn = [&](const Vec3& w) {
        return std::cos(angle) * w + std::sin(angle) * Cross(axis, w) + ((1 - std::cos(angle)) * Dot(axis, w)) * axis;
      };
      return SpecularWithDirections(slopes, 0.3, turn(wi), turn(wo)).value;
    };
    const double along = Dot(f.dwi, Cross(axis, wi)) + Dot(f.dwo, Cross(axis, wo));
    const double size = f.value * 20;
    EXPECT_NEAR(along, Difference(turned, 0, 1e-4), 1e-7 * size + 1e-9);
  }
}

TEST(Mirrored, RetroLobePeaksBackwards) {
  const SlopeNormalDistribution lobe({Family::kGgx, 0.1, 0.1, 0, 0, 0});
  const Vec3 wi = Normalized(Vec3{0.5, 0.2, 1});
  const double back = MicrofacetSpecular(lobe, {}, wi, Mirrored(wi));
  ShapeGenerator random(406);
  for (int i = 0; i < 100; ++i) {
    const Vec3 wo = Normalized(Vec3{wi.x + random.Uniform(-0.1, 0.1), wi.y + random.Uniform(-0.1, 0.1), wi.z});
    EXPECT_LT(MicrofacetSpecular(lobe, {}, wo, Mirrored(wi)) * wo.z, back * wi.z * 1.3);
    EXPECT_NEAR(MicrofacetSpecular(lobe, {}, wo, Mirrored(wi)), MicrofacetSpecular(lobe, {}, wi, Mirrored(wo)),
                1e-13 * back);
  }
}

}  // namespace
}  // namespace lobefit
