#include "lobefit/measurement/checks/isotropy.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

TEST(SpreadOverAzimuths, TurnsEveryPairAsAWhole) {
  Samples samples;
  samples.values.resize(1);
  for (int k = 0; k < 200; ++k) {
    const double value = k;
    samples.Append(FromSpherical(0.4, 0.3), FromSpherical(0.9, 0.3 + 0.01 * k), &value, static_cast<std::uint32_t>(k));
  }
  const Samples spread = SpreadOverAzimuths(samples);
  double sum_x = 0, sum_y = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(spread.wi_z[i], samples.wi_z[i]);
    EXPECT_EQ(spread.wo_z[i], samples.wo_z[i]);
    EXPECT_NEAR(Dot(spread.wi(i), spread.wo(i)), Dot(samples.wi(i), samples.wo(i)), 1e-14);
    EXPECT_EQ(spread.values[0][i], samples.values[0][i]);
    sum_x += spread.wi_x[i];
    sum_y += spread.wi_y[i];
  }
  // The azimuths of wi, all the same before, cover the circle.
  EXPECT_LT(std::hypot(sum_x, sum_y) / 200, 0.02 * std::sin(0.4));
}

// Nine incidences at one azimuth, the hemisphere of viewers, of a lobe whose widths along x and y, turned by `turn`,
// are given, with the relative scatter of an instrument.
Measurement OneAzimuth(double alpha_x, double alpha_y, double turn, double scatter) {
  MeasurementBuilder builder({{"Y"}, {}});
  std::uint32_t line = 0;
  for (double theta_i = 0; theta_i <= 80; theta_i += 10) {
    const Vec3 wi = FromSpherical(DegreesToRadians(theta_i), 0);
    for (double theta_o = 0; theta_o <= 80; theta_o += 5) {
      for (double phi = 0; phi < 360; phi += theta_o == 0 ? 360 : 15) {
        const Vec3 wo = FromSpherical(DegreesToRadians(theta_o), DegreesToRadians(phi)), h = Normalized(wi + wo);
        const double x = (std::cos(turn) * h.x + std::sin(turn) * h.y) / (h.z * alpha_x),
                     y = (std::cos(turn) * h.y - std::sin(turn) * h.x) / (h.z * alpha_y);
        const double value = (0.05 + std::pow(1 + x * x + y * y, -2)) * (1 + scatter * std::sin(1e4 * ++line));
        builder.Add(wi, wo, &value, line);
      }
    }
  }
  return builder.Finish();
}

TEST(IsotropicPairs, ShowIsotropyAndItsLack) {
  for (const double scatter : {0.0, 0.02}) {
    for (const double alpha : {0.1, 0.25, 0.6}) {
      const IsotropicPairs pairs = CompareIsotropicPairs(OneAzimuth(alpha, alpha, 0, scatter));
      EXPECT_TRUE(pairs.ShowIsotropy()) << alpha << " " << scatter << ": " << pairs.pairs << " pairs, " << pairs.bright
                                        << " bright, " << pairs.median << " " << pairs.bright_median;
    }
    for (const double turn : {0.0, 0.3, kPi / 4, kPi / 2}) {
      for (const double alpha_y : {0.15, 0.2, 0.5}) {
        const IsotropicPairs pairs = CompareIsotropicPairs(OneAzimuth(0.3, alpha_y, turn, scatter));
        EXPECT_FALSE(pairs.ShowIsotropy())
            << alpha_y << " " << turn << ": " << pairs.median << " " << pairs.bright_median;
      }
    }
  }
  EXPECT_FALSE(CompareIsotropicPairs(OneAzimuth(0.25, 0.25, 0, 0.2)).ShowIsotropy()) << "noise hides it";
}

}  // namespace
}  // namespace lobefit
