#include "lobefit/measurement/interpolation.h"

#include <cmath>

#include "tests/support/test_brdf.h"
#include <gtest/gtest.h>

#include "lobefit/synthesis/synthesis.h"

namespace lobefit {
namespace {

Measurement Measure(const TestBrdf& brdf, double step_deg) {
  GoniometerLayout layout;
  for (int theta = 0; theta <= 75; theta += 15) layout.polar_angles.push_back(DegreesToRadians(theta));
  for (int phi = 0; phi < 360; phi += 30) layout.azimuths.push_back(DegreesToRadians(phi));
  layout.detector_step = DegreesToRadians(step_deg);
  return Synthesise(
      Goniometer(layout), {{"Y"}, {}},
      [&](const Vec3& wi, const Vec3& wo, double* values) { values[0] = brdf(wi, wo); }, {}, 1);
}

TEST(Interpolator, MeetsItsSamples) {
  const TestBrdf brdf;
  const Measurement m = Measure(brdf, 10);
  const Interpolator interpolator(m);
  for (std::size_t i = 0; i < m.samples.size(); i += 7) {
    double value = 0;
    interpolator.Evaluate(m.samples.wi(i), m.samples.wo(i), &value);
    ASSERT_NEAR(value / m.samples.values[0][i], 1, 1e-6) << i;
    // Reciprocity is used: the exchanged pair has the same value.
    interpolator.Evaluate(m.samples.wo(i), m.samples.wi(i), &value);
    ASSERT_NEAR(value / m.samples.values[0][i], 1, 1e-6) << i;
  }
}

TEST(Interpolator, IsAccurateBetweenSamples) {
  TestBrdf brdf;
  brdf.alpha_x = 0.3;
  brdf.alpha_y = 0.4;
  const Measurement m = Measure(brdf, 5);
  std::vector<double> errors;
  const Interpolator interpolator(m);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 wi = FromSpherical(0.1 + 1.0 * std::fmod(i * 0.618, 1.0), i * 2.4);
    const Vec3 wo = FromSpherical(0.05 + 1.1 * std::fmod(i * 0.414, 1.0), i * 1.7);
    double value = 0;
    interpolator.Evaluate(wi, wo, &value);
    errors.push_back(std::fabs(value / brdf(wi, wo) - 1));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.02);
  EXPECT_LT(errors[errors.size() * 9 / 10], 0.08);
}

TEST(Interpolator, NegativeValuesAreInterpolatedToo) {
  Measurement m = Measure(TestBrdf(), 10);
  for (double& value : m.samples.values[0]) value = -value;
  double value = 0;
  Interpolator(m).Evaluate(m.samples.wi(11), m.samples.wo(11), &value);
  EXPECT_NEAR(value / m.samples.values[0][11], 1, 1e-6);
}

TEST(CompareWith, MeasuresRelativeDifferences) {
  const TestBrdf brdf;
  const Measurement m = Measure(brdf, 10);
  const Difference same =
      CompareWith(m, [&](const Vec3& wi, const Vec3& wo, double* values) { values[0] = brdf(wi, wo); });
  EXPECT_LT(same.maximum, 1e-12);
  EXPECT_EQ(same.compared, m.samples.size());
  const Difference more =
      CompareWith(m, [&](const Vec3& wi, const Vec3& wo, double* values) { values[0] = 1.1 * brdf(wi, wo); });
  EXPECT_NEAR(more.median, 0.1, 1e-9);
  EXPECT_NEAR(more.maximum, 0.1, 1e-9);
}

}  // namespace
}  // namespace lobefit
