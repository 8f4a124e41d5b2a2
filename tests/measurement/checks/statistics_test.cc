#include "lobefit/measurement/checks/statistics.h"

#include <cmath>

#include "tests/support/test_brdf.h"
#include <gtest/gtest.h>

#include "lobefit/synthesis/synthesis.h"

namespace lobefit {
namespace {

Measurement Measure(const BrdfFunction& brdf) {
  GoniometerLayout layout;
  layout.polar_angles = {0, DegreesToRadians(30), DegreesToRadians(60)};
  layout.azimuths = {0, kPi / 2};
  layout.detector_step = DegreesToRadians(5);
  layout.theta_max = DegreesToRadians(85);
  return Synthesise(Goniometer(layout), {{"Y"}, {}}, brdf, {}, 1);
}

TEST(Describe, LambertHasItsAlbedo) {
  const Measurement m = Measure([](const Vec3&, const Vec3&, double* values) { values[0] = 0.8 / kPi; });
  const Statistics statistics = Describe(m);
  ASSERT_FALSE(statistics.incidences.empty());
  for (const IncidenceStatistics& incidence : statistics.incidences) {
    EXPECT_NEAR(incidence.albedo[0], 0.8, 0.004);
    EXPECT_GT(incidence.coverage, 0.95);
  }
  EXPECT_TRUE(statistics.ConservesEnergy());
  EXPECT_EQ(statistics.azimuths_deg, (std::vector<double>{0, 90}));
  EXPECT_EQ(statistics.channels[0].negative, 0U);
  EXPECT_DOUBLE_EQ(statistics.channels[0].median, 0.8 / kPi);
  EXPECT_FALSE(
      Describe(Measure([](const Vec3&, const Vec3&, double* values) { values[0] = 1.1 / kPi; })).ConservesEnergy());
}

// The quadrature of the albedo against an independent one, for a lobe that leans over.
TEST(Describe, AlbedoOfALeaningLobe) {
  const TestBrdf brdf;
  const BrdfFunction function = [&](const Vec3& wi, const Vec3& wo, double* values) { values[0] = brdf(wi, wo); };
  const Statistics statistics = Describe(Measure(function), function);
  for (const IncidenceStatistics& incidence : statistics.incidences) {
    double exact = 0;
    constexpr int kN = 400;
    for (int a = 0; a < kN; ++a) {
      for (int b = 0; b < kN; ++b) {
        const Vec3 wo = FromSpherical(std::acos(std::sqrt((a + 0.5) / kN)), (b + 0.5) / kN * 2 * kPi);
        exact += kPi / (kN * kN) * brdf(incidence.wi, wo);
      }
    }
    EXPECT_NEAR(incidence.albedo[0] / exact, 1, 0.01);
  }
}

TEST(Describe, FindsBrokenReciprocity) {
  const auto pairs = [](double factor) {
    MeasurementBuilder builder({{"Y"}, {}});
    for (int a = 0; a < 6; ++a) {
      for (int b = 0; b < 6; ++b) {
        const Vec3 wi = FromSpherical(0.2 * a, 0.3), wo = FromSpherical(0.2 * b, 1.9);
        const double forward = 1.0, backward = factor;
        builder.Add(wi, wo, &forward, 0);
        builder.Add(wo, wi, &backward, 0);
      }
    }
    return Describe(builder.Finish());
  };
  EXPECT_GT(pairs(1).reciprocal_pairs, 50U);
  EXPECT_NEAR(pairs(1).reciprocity_median, 0, 1e-12);
  EXPECT_NEAR(pairs(1.2).reciprocity_median, 0.2 / 1.1, 1e-9);
}

TEST(Describe, APlaneOfIncidenceHasNoAlbedo) {
  GoniometerLayout layout;
  layout.polar_angles = {0.5, 1.0};
  layout.azimuths = {0};
  layout.in_plane = true;
  const Measurement m = Synthesise(
      Goniometer(layout), {{"Y"}, {}}, [](const Vec3&, const Vec3&, double* values) { values[0] = 1; }, {}, 1);
  const Statistics statistics = Describe(m);
  EXPECT_TRUE(statistics.incidences.empty());
  EXPECT_TRUE(std::isnan(statistics.largest_albedo));
  EXPECT_TRUE(statistics.ConservesEnergy());
}

}  // namespace
}  // namespace lobefit
