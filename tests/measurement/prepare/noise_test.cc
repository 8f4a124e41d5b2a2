#include "lobefit/measurement/prepare/noise.h"

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

TEST(AddSigma, IndependentSourcesAddTheirVariances) {
  Measurement m = Scan(0, true);
  AddSigma(std::vector<double>(m.samples.size(), 0.03), &m.samples);
  AddSigma(std::vector<double>(m.samples.size(), 0.04), &m.samples);
  ASSERT_EQ(m.samples.sigma.size(), m.samples.size());
  for (const double sigma : m.samples.sigma) EXPECT_NEAR(sigma, 0.05, 1e-15);
  EXPECT_TRUE(m.samples.weight.empty());
  m.samples.sigma[3] = 7;
  EXPECT_EQ(m.samples.Subset({3}).sigma, std::vector<double>({7}));
  std::vector<std::uint8_t> keep(m.samples.size(), 0);
  keep[3] = 1;
  m.samples.Keep(keep);
  EXPECT_EQ(m.samples.sigma, std::vector<double>({7}));
}

TEST(AddNoiseFloor, IsOfTheReading) {
  MeasurementBuilder builder({{"Y"}, {}});
  for (const double theta_i : {0.1, 1.4}) {
    const double f = 0;
    builder.Add(FromSpherical(theta_i, 0), FromSpherical(0.2, 1), &f, 0);
  }
  Measurement m = builder.Finish();
  AddNoiseFloor(0.01, &m.samples);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(m.samples.sigma[i] * m.samples.wi_z[i], 0.01, 1e-15);
}

}  // namespace
}  // namespace lobefit
