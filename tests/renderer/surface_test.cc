// The reflectance models of renderers against laws that they obey whatever their parameters.
#include "lobefit/renderer/surface.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lobefit/math/directions.h"
#include "lobefit/renderer/gltf_material.h"
#include "lobefit/renderer/open_pbr.h"

namespace lobefit {
namespace {

Vec3 At(double theta_deg, double phi_deg) {
  return FromSpherical(DegreesToRadians(theta_deg), DegreesToRadians(phi_deg));
}

std::array<double, 3> Values(const BrdfFunction& brdf, const Vec3& wi, const Vec3& wo) {
  std::array<double, 3> values;
  brdf(wi, wo, values.data());
  return values;
}

// What of the light from all of `wi` goes to `wo`, by midpoints over the projected hemisphere.
double AlbedoOf(const BrdfFunction& brdf, const Vec3& wo) {
  constexpr int kRings = 200, kTurns = 400;
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double sin2 = (i + 0.5) / kRings;
    for (int k = 0; k < kTurns; ++k)
      sum += Values(brdf, FromSpherical(std::asin(std::sqrt(sin2)), (k + 0.5) / kTurns * 2 * kPi), wo)[0];
  }
  return sum * kPi / (kRings * kTurns);
}

Surface MakeLobe(const Widths& widths, SurfaceMasking masking) {
  Surface surface;
  surface.masking = masking;
  SurfaceLobe lobe;
  lobe.widths = widths;
  lobe.rotation = 0.4;
  lobe.fresnel.f0 = {1, 0.5, 0.04};
  surface.lobes.push_back(lobe);
  return surface;
}

class MaskedSurface : public testing::TestWithParam<SurfaceMasking> {};

TEST_P(MaskedSurface, IsReciprocal) {
  const BrdfFunction brdf = SurfaceBrdf(MakeLobe({0.5, 0.2}, GetParam()));
  for (int k = 0; k < 40; ++k) {
    const Vec3 wi = At(2 + 2.1 * k, 37.0 * k), wo = At(85 - 1.9 * k, 11.0 * k);
    const std::array<double, 3> there = Values(brdf, wi, wo), back = Values(brdf, wo, wi);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(there[c] / back[c], 1, 1e-12) << k;
  }
}

// Along the normal nothing is masked: D / 4 = 1 / (4 pi alpha_1 alpha_2), times the reflectance.
TEST_P(MaskedSurface, HasItsPeakAlongTheNormal) {
  const std::array<double, 3> peak = Values(SurfaceBrdf(MakeLobe({0.5, 0.2}, GetParam())), {0, 0, 1}, {0, 0, 1});
  EXPECT_NEAR(peak[0], 1 / (4 * kPi * 0.1), 1e-12);
  EXPECT_NEAR(peak[2] / peak[0], 0.04, 1e-12);
}

TEST_P(MaskedSurface, SendsOnNoMoreThanArrives) {
  // Masking by the mean width is none of a surface whose widths differ: it gains 8 % at 80 degrees.
  const Widths widths = GetParam() == SurfaceMasking::kMeanAlpha ? Widths{0.45, 0.45} : Widths{0.6, 0.3};
  for (const double theta : {0.0, 40.0, 80.0}) {
    const double albedo = AlbedoOf(SurfaceBrdf(MakeLobe(widths, GetParam())), At(theta, 20));
    EXPECT_LT(albedo, 1.01) << theta;
    EXPECT_GT(albedo, 0.5) << theta;
  }
}

INSTANTIATE_TEST_SUITE_P(Maskings, MaskedSurface,
                         testing::Values(SurfaceMasking::kHeightCorrelated, SurfaceMasking::kSeparable,
                                         SurfaceMasking::kMeanAlpha));

// The long axis of the highlight of a lobe that is turned lies where its rotation says.
TEST(Surface, IsStretchedAlongItsTangent) {
  const BrdfFunction brdf = SurfaceBrdf(MakeLobe({0.5, 0.1}, SurfaceMasking::kHeightCorrelated));
  const double turn = RadiansToDegrees(0.4);
  const double along = Values(brdf, At(30, turn), At(30, turn))[0],
               across = Values(brdf, At(30, turn + 90), At(30, turn + 90))[0];
  EXPECT_GT(along, 10 * across);
  EXPECT_NEAR(along, Values(brdf, At(30, turn + 180), At(30, turn + 180))[0], 1e-12);
}

// White furnace: what a rough lobe with F = 1 loses between its facets is given back.
TEST(Surface, CompensationOfEnergyIsComplete) {
  Surface surface = MakeLobe({0.7, 0.7}, SurfaceMasking::kHeightCorrelated);
  const Vec3 wo = At(35, 0);
  EXPECT_LT(AlbedoOf(SurfaceBrdf(surface), wo), 0.95);
  surface.energy_compensation = true;
  EXPECT_NEAR(AlbedoOf(SurfaceBrdf(surface), wo), 1, 0.005);
}

// The table by sampled normals against the integral of the lobe that it stands for.
TEST(IsotropicAlbedo, IsThatOfTheLobe) {
  for (const double alpha : {0.2, 0.6}) {
    const IsotropicAlbedo albedo(alpha);
    Surface surface = MakeLobe({alpha, alpha}, SurfaceMasking::kHeightCorrelated);
    surface.lobes[0].fresnel.f0 = {0.3, 0.3, 0.3};
    surface.lobes[0].fresnel.f90 = {0.9, 0.9, 0.9};
    for (const double theta : {0.0, 50.0, 70.0}) {
      const Vec3 wo = At(theta, 0);
      EXPECT_NEAR(albedo(wo.z, 0.3, 0.9), AlbedoOf(SurfaceBrdf(surface), wo), 0.004) << alpha << ' ' << theta;
    }
  }
}

TEST(ConductorOfReflectance, HasIt) {
  for (const double r : {0.0, 0.04, 0.5, 0.95}) EXPECT_NEAR(FresnelConductor(1, ConductorOfReflectance(r)), r, 1e-12);
}

TEST(NearestConductor, FindsACurveOfItsOwnKind) {
  for (const ConductorIndex& index : {ConductorIndex{0.2, 3.4}, ConductorIndex{2.5, 3.0}}) {
    const auto curve = [&index](double c) { return FresnelConductor(c, index); };
    const ConductorIndex found = NearestConductor(curve);
    for (const double c : {1.0, 0.7, 0.3, 0.1}) EXPECT_NEAR(FresnelConductor(c, found), curve(c), 2e-3) << c;
  }
}

TEST(SurfaceFresnel, TintAt82DegreesIsTheFactorThere) {
  SurfaceFresnel plain;
  plain.f0 = {0.5, 0.6, 0.7};
  SurfaceFresnel tinted = plain;
  tinted.f82 = {0.3, 1, 0.8};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(tinted(c, 1.0 / 7), tinted.f82[c] * plain(c, 1.0 / 7), 1e-12);
    EXPECT_NEAR(tinted(c, 1), plain.f0[c], 1e-15) << "and changes nothing at the normal";
    EXPECT_NEAR(tinted(c, 0), 1, 1e-15) << "nor at grazing incidence";
  }
}

TEST(GltfSurface, ADielectricThatReflectsNothingIsItsBase) {
  GltfMaterial material;
  material.metallic = 0;
  material.specular = 0;
  material.base_color = {0.2, 0.4, 0.8};
  const BrdfFunction brdf = SurfaceBrdf(GltfSurface(material));
  for (const Vec3& wi : {At(10, 0), At(60, 100)}) {
    const std::array<double, 3> values = Values(brdf, wi, At(40, 200));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(values[c], material.base_color[c] / kPi, 1e-12);
  }
}

TEST(GltfSurface, AMetalHasNoDiffusePart) {
  GltfMaterial material;
  material.roughness = {0.2, 0};
  material.base_color = {0.9, 0.6, 0.3};
  const BrdfFunction brdf = SurfaceBrdf(GltfSurface(material));
  // Far off the lobe of alpha 0.04.
  EXPECT_LT(Values(brdf, At(70, 0), At(70, 0))[0], 2e-3);
  const std::array<double, 3> peak = Values(brdf, {0, 0, 1}, {0, 0, 1});
  EXPECT_NEAR(peak[0], 0.9 / (4 * kPi * std::pow(0.2, 4)), 1e-9);
  EXPECT_NEAR(peak[2] / peak[0], 1.0 / 3, 1e-12);
}

// A clear coat of the surroundings' index is not there: near the normal, where Schlick's term of its albedo is none.
TEST(OpenPbrSurface, ACoatThatBendsNoLightIsInvisible) {
  OpenPbr bare;
  bare.base_color = {0.7, 0.4, 0.2};
  bare.metalness = 0.3;
  bare.roughness = {0.5, 0.4};
  OpenPbr coated = bare;
  coated.coat.weight = 1;
  coated.coat.ior = 1;
  coated.coat.roughness = {1e-3, 0};
  const BrdfFunction a = SurfaceBrdf(OpenPbrSurface(bare)), b = SurfaceBrdf(OpenPbrSurface(coated));
  for (const auto& [wi, wo] : {std::pair{At(20, 0), At(2, 170)}, {At(60, 90), At(3, 300)}}) {
    const std::array<double, 3> without = Values(a, wi, wo), with = Values(b, wi, wo);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(with[c] / without[c], 1, 1e-6);
  }
}

// A dark coat colours what lies below and leaves its own reflection.
TEST(OpenPbrSurface, TheCoatsColourDimsTheBase) {
  OpenPbr clear;
  clear.coat.weight = 1;
  clear.coat.roughness = {0.02, 0};
  OpenPbr red = clear;
  red.coat.color = {1, 0.5, 0};
  // Off the mirror direction, where the coat itself sends nothing.
  const std::array<double, 3> a = Values(SurfaceBrdf(OpenPbrSurface(clear)), At(30, 0), At(60, 90)),
                              b = Values(SurfaceBrdf(OpenPbrSurface(red)), At(30, 0), At(60, 90));
  EXPECT_NEAR(b[0] / a[0], 1, 1e-9);
  EXPECT_NEAR(b[1] / a[1], 0.5, 1e-3);
  EXPECT_NEAR(b[2] / a[2], 0, 1e-3);
}

TEST(Surface, IsBlackBelowTheHorizon) {
  const BrdfFunction brdf = SurfaceBrdf(OpenPbrSurface({}));
  for (const double v : Values(brdf, At(95, 0), At(20, 0))) EXPECT_EQ(v, 0);
  for (const double v : Values(brdf, At(20, 0), {1, 0, 0})) EXPECT_EQ(v, 0);
}

}  // namespace
}  // namespace lobefit
