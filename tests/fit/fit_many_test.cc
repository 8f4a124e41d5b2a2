#include "lobefit/fit/fit_many.h"

#include <cmath>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/fit/fit.h"

namespace lobefit {
namespace {

GoniometerLayout SmallLayout() {
  GoniometerLayout layout;
  layout.polar_angles = {DegreesToRadians(20), DegreesToRadians(55)};
  layout.azimuths = {0, 1};
  layout.detector_step = DegreesToRadians(20);
  return layout;
}

std::vector<Measurement> Problems(std::size_t count, double noise) {
  std::vector<Measurement> measurements;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) / static_cast<double>(count);
    measurements.push_back(Synthetic(OneLobe(Ndf::kEllipsoid, 0.1 + 0.4 * t, 0.08 + 0.2 * t * t, 4 * t, -3 + 5 * t,
                                             80 - 150 * t, {0.2 + 0.6 * t}, {0.3 * t}),
                                     SmallLayout(), noise, k));
  }
  return measurements;
}

std::vector<const Samples*> SamplesOf(const std::vector<Measurement>& measurements) {
  std::vector<const Samples*> samples;
  for (const Measurement& measurement : measurements) samples.push_back(&measurement.samples);
  return samples;
}

const Recipe kRecipe = DefaultRecipe({{Lobe{}}, Diffuse::kLambert}, "test");

TEST(FitMany, ReachesTheCostOfTheFullSearch) {
  std::vector<Measurement> measurements = Problems(60, 0.05);
  const std::vector<SmallFit> fits = FitMany(kRecipe, SamplesOf(measurements), {});
  for (std::size_t k = 0; k < fits.size(); ++k) {
    EXPECT_TRUE(fits[k].converged) << k;
    const Material material = CheckedFit(kRecipe, {}, &measurements[k]);
    EXPECT_LE(fits[k].cost, material.cost * (1 + 1e-6)) << k;
  }
}

TEST(FitMany, RecoversWithoutNoise) {
  const std::vector<Measurement> measurements = Problems(40, 0);
  const std::vector<SmallFit> fits = FitMany(kRecipe, SamplesOf(measurements), {});
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const double t = static_cast<double>(k) / 40;
    EXPECT_NEAR(fits[k].values[5][0], 0.2 + 0.6 * t, 1e-7) << k;
    EXPECT_NEAR(fits[k].values[6][0], 0.3 * t, 1e-7) << k;
    EXPECT_LT(fits[k].cost, 1e-12) << k;
  }
}

TEST(FitMany, SameBitsOnOneAndEightThreads) {
  const std::vector<Measurement> measurements = Problems(40, 0.05);
  FitManyOptions eight;
  eight.threads = 8;
  const std::vector<SmallFit> a = FitMany(kRecipe, SamplesOf(measurements), {}),
                              b = FitMany(kRecipe, SamplesOf(measurements), eight);
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].values, b[k].values);
}

TEST(FitMany, SaysWhatItCannotDo) {
  const std::vector<Measurement> measurements = Problems(1, 0);
  EXPECT_THROW(FitMany(DefaultRecipe({{Lobe{}, Lobe{}}, Diffuse::kLambert}, "two"), SamplesOf(measurements), {}),
               InputError);
  EXPECT_THROW(FitMany(DefaultRecipe({{{Ndf::kGgx, Masking::kSmithHeight, Fresnel::kConductor}}, Diffuse::kNone}, "c"),
                       SamplesOf(measurements), {}),
               InputError);
  const Samples few = measurements[0].samples.Subset({0, 1, 2});
  EXPECT_FALSE(FitMany(kRecipe, {&few}, {})[0].converged);
  EXPECT_TRUE(FitMany(kRecipe, {}, {}).empty());
}

}  // namespace
}  // namespace lobefit
