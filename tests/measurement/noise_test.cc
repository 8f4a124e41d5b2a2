#include "lobefit/measurement/noise.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// A scan of the viewer by single degrees: a lobe above noise, whose sign is kept or not.
Measurement Scan(double sigma, bool rectified) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, sigma);
  MeasurementBuilder builder({{"Y"}, {}});
  for (int plane = 0; plane < 3; ++plane) {
    for (int degrees = -80; degrees <= 80; ++degrees) {
      const double theta = DegreesToRadians(degrees);
      const Vec3 wi = FromSpherical(0.3 + 0.1 * plane, 0);
      const double lobe = 5 * std::exp(-std::pow((degrees - 20) / 8.0, 2));
      const double reading = lobe + normal(random);
      const double f = (rectified ? std::fabs(reading) : reading) / wi.z;
      builder.Add(wi, {-std::sin(theta), 0.001, std::cos(theta)}, &f, 0);
    }
  }
  return builder.Finish();
}

TEST(FindRectifiedNoise, FindsTheFloorOfMagnitudes) {
  const auto noise = FindRectifiedNoise(Scan(1e-3, true));
  ASSERT_TRUE(noise.has_value());
  EXPECT_NEAR(noise->floor / 1e-3, 1, 0.3);
  EXPECT_GT(noise->samples_below, 200U);
}

TEST(FindRectifiedNoise, SignedNoiseAndCleanLobesAreNotRectified) {
  EXPECT_FALSE(FindRectifiedNoise(Scan(1e-3, false)).has_value());
  MeasurementBuilder builder({{"Y"}, {}});
  for (int degrees = -80; degrees <= 80; ++degrees) {
    const double theta = DegreesToRadians(degrees), f = 1e-3 + 5 * std::exp(-std::pow((degrees - 20) / 8.0, 2));
    builder.Add({0, 0, 1}, {-std::sin(theta), 0, std::cos(theta)}, &f, 0);
  }
  EXPECT_FALSE(FindRectifiedNoise(builder.Finish()).has_value());
}

TEST(WeighBySigma, IsTheInverseVarianceOfTheLogarithmAboveTheMedian) {
  Measurement m = Scan(0, true);
  std::vector<double> sigma(m.samples.size(), 0.01);
  sigma[5] = 1.0;
  WeighBySigma(sigma, &m);
  double sum = 0;
  for (const double weight : m.samples.weight) sum += weight;
  EXPECT_NEAR(sum, static_cast<double>(m.samples.size()), 1e-9);
  // The uncertain sample counts next to nothing, and none more than twice the usual one.
  EXPECT_LT(m.samples.weight[5], 1e-3);
  for (const double weight : m.samples.weight) EXPECT_LT(weight, 2.1);
}

TEST(WeighByNoiseFloor, GrazingLightHasTheSameReadingNoise) {
  MeasurementBuilder builder({{"Y"}, {}});
  for (const double theta_i : {0.1, 1.4}) {
    const double f = 0;
    builder.Add(FromSpherical(theta_i, 0), FromSpherical(0.2, 1), &f, 0);
  }
  Measurement m = builder.Finish();
  WeighByNoiseFloor(0.01, &m);
  EXPECT_NEAR(m.samples.weight[0], m.samples.weight[1], 1e-12);
}

}  // namespace
}  // namespace lobefit
