#include "lobefit/measurement/checks/plausibility.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// A hemisphere of viewers every 10 degrees for three incident directions, with f_r of the pair of directions.
Measurement Hemisphere(const std::function<double(const Vec3&, const Vec3&)>& f) {
  MeasurementBuilder builder({{"Y"}, {}});
  std::uint32_t line = 0;
  for (const double theta_i : {20.0, 40.0, 60.0}) {
    const Vec3 wi = FromSpherical(DegreesToRadians(theta_i), 0);
    for (double theta_o = 0; theta_o <= 80; theta_o += 10) {
      for (double phi = 0; phi < 360; phi += theta_o == 0 ? 360 : 20) {
        const Vec3 wo = FromSpherical(DegreesToRadians(theta_o), DegreesToRadians(phi));
        const double value = f(wi, wo);
        builder.Add(wi, wo, &value, ++line);
      }
    }
  }
  return builder.Finish();
}

double Lobe(const Vec3& wi, const Vec3& wo) {
  const Vec3 mirror = {-wi.x, -wi.y, wi.z};
  return 0.1 + 2 * std::exp(30 * (Dot(mirror, wo) - 1));
}

bool Says(const Measurement& measurement, std::string_view part) {
  for (const std::string& remark : FindImplausible(measurement)) {
    if (remark.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(Plausibility, NothingIsSaidOfAnOrdinarySurface) {
  EXPECT_TRUE(FindImplausible(Hemisphere(Lobe)).empty());
  EXPECT_TRUE(FindImplausible(Hemisphere([](const Vec3&, const Vec3&) { return 0.99 / kPi; })).empty());
  // Noise about zero has a few negative readings and no mark.
  EXPECT_TRUE(FindImplausible(Hemisphere([](const Vec3& wi, const Vec3& wo) {
                return 0.01 + 0.02 * std::sin(1000 * (wi.x + wo.y + 3 * wo.x));
              })).empty());
}

// Angles that rounding has moved off the bounds of the rings by which the albedo is estimated.
TEST(Plausibility, DenseSamplesAboutThePeakAreNotTheWholeRing) {
  MeasurementBuilder builder({{"Y"}, {}});
  std::uint32_t line = 0;
  for (const double theta_i : {30.0, 50.0, 70.0}) {
    const Vec3 wi = FromSpherical(DegreesToRadians(theta_i), 0);
    const auto add = [&](double theta_o, double phi) {
      const double rounding = 1e-7 * (line % 3 == 0 ? -1 : 1);
      const Vec3 wo = FromSpherical(DegreesToRadians(theta_o + rounding), DegreesToRadians(phi));
      const double value = 10 * Lobe(wi, wo) * 0.02;
      builder.Add(wi, wo, &value, ++line);
    };
    for (double theta_o = 0; theta_o <= 80; theta_o += 20) {
      for (double phi = 0; phi < 360; phi += theta_o == 0 ? 360 : 20) add(theta_o, phi);
    }
    for (const double offset : {-5.0, -2.5, 2.5, 5.0}) add(theta_i + offset, 180);
  }
  for (const std::string& remark : FindImplausible(builder.Finish())) ADD_FAILURE() << remark;
}

TEST(Plausibility, ALobeAboutTheLightsOwnDirection) {
  const auto turned = [](const Vec3& wi, const Vec3& wo) { return Lobe({-wi.x, -wi.y, wi.z}, wo); };
  EXPECT_TRUE(
      Says(Hemisphere(turned), "in 3 of 3 incident directions the largest values lie about the light's own direction"));
  EXPECT_TRUE(Says(Hemisphere(turned), "--incident propagation"));
  // A retro-reflecting part beside a mirror-like one is no exchanged convention.
  EXPECT_FALSE(Says(Hemisphere([&](const Vec3& wi, const Vec3& wo) { return Lobe(wi, wo) + 0.8 * turned(wi, wo); }),
                    "light's own"));
}

TEST(Plausibility, MoreLightThanArrives) {
  const auto times = [](double factor) {
    return Hemisphere([factor](const Vec3& wi, const Vec3& wo) { return factor * Lobe(wi, wo); });
  };
  EXPECT_TRUE(Says(times(100), "more light leaves than arrives"));
  EXPECT_TRUE(Says(times(100), "--scale free"));
  EXPECT_TRUE(Says(Hemisphere([](const Vec3&, const Vec3&) { return 0.95; }), "--value-kind pi-f"));
  EXPECT_TRUE(Says(Hemisphere([](const Vec3&, const Vec3&) { return 95.0; }), "--value-scale %"));
  EXPECT_TRUE(Says(Hemisphere([](const Vec3& wi, const Vec3& wo) { return std::log10(0.3 * Lobe(wi, wo)); }),
                   "--value-scale log10"));
}

TEST(Plausibility, MarksAndSaturation) {
  const auto shaded = [](const Vec3& wi, const Vec3& wo) {
    return Dot(wi, wo) > std::cos(DegreesToRadians(12)) ? 0.0 : Lobe(wi, wo);
  };
  EXPECT_TRUE(Says(Hemisphere(shaded), "are exactly 0, all within"));
  EXPECT_TRUE(Says(Hemisphere(shaded), "--no-value 0"));
  EXPECT_TRUE(Says(Hemisphere(shaded), "--exclude retro:"));
  EXPECT_FALSE(Says(Hemisphere(shaded), "negative readings"));
  const auto clipped = [](const Vec3& wi, const Vec3& wo) { return wo.z < 0.4 ? 0.0 : Lobe(wi, wo); };
  EXPECT_TRUE(Says(Hemisphere(clipped), "if negative readings were set to 0, give them as they were read"));
  const auto marked = [](const Vec3& wi, const Vec3& wo) { return wo.z > 0.99 ? -999.0 : Lobe(wi, wo); };
  EXPECT_TRUE(Says(Hemisphere(marked), "--no-value -999"));
  const auto filled = [](const Vec3& wi, const Vec3& wo) { return wo.z > 0.99 ? -88.5 : Lobe(wi, wo); };
  EXPECT_TRUE(Says(Hemisphere(filled), "--no-value -88.5"));
  // A detector's least step below its zero is noise.
  const auto stepped = [](const Vec3& wi, const Vec3& wo) { return wo.z < 0.4 ? -0.01 : Lobe(wi, wo); };
  EXPECT_FALSE(Says(Hemisphere(stepped), "--no-value"));
  const auto saturated = [](const Vec3& wi, const Vec3& wo) { return std::min(0.8, Lobe(wi, wo) + 1e-3 * wo.x); };
  EXPECT_TRUE(Says(Hemisphere(saturated), "share the largest value, 0.8"));
}

TEST(Plausibility, PeaksThatFollowFromAnglesOfAnotherOrigin) {
  // The light as stated, the lobe where it would be if theta_o counted from the mirror direction or the surface.
  const auto offset = [](const Vec3&, const Vec3& wo) { return Lobe({0, 0, 1}, wo); };
  EXPECT_TRUE(Says(Hemisphere(offset), "the largest values lie about the normal and not the mirror direction"));
  const auto grazing = [](const Vec3& wi, const Vec3& wo) { return Lobe({wi.z, 0, wi.x}, wo); };
  EXPECT_TRUE(Says(Hemisphere(grazing), "--columns elevation_o=NAME"));
}

TEST(Plausibility, UncertaintiesAboveTheirValues) {
  Measurement m = Hemisphere(Lobe);
  for (std::size_t i = 0; i < m.samples.size(); ++i) m.samples.sigma.push_back(0.05 * m.samples.values[0][i]);
  EXPECT_FALSE(Says(m, "stated uncertainties"));
  for (double& sigma : m.samples.sigma) sigma *= 100;
  EXPECT_TRUE(Says(m, "half of the stated uncertainties are above 500 % of the value"));
}

}  // namespace
}  // namespace lobefit
