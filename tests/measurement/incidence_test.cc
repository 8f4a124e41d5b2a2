#include "lobefit/measurement/incidence.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// Samples whose lights stand at the given angles in degrees, moved by `jitter` in a fixed pattern; `repeats` of each.
Measurement Lights(const std::vector<std::pair<double, double>>& theta_phi, double jitter, int repeats) {
  Measurement measurement;
  measurement.samples.values.resize(1);
  const double value = 1;
  std::uint32_t k = 0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (const auto& [theta, phi] : theta_phi) {
      const double a = jitter * std::sin(3.7 * k), b = jitter * std::cos(5.1 * k);
      measurement.samples.Append(FromSpherical(DegreesToRadians(theta + a), DegreesToRadians(phi + b)),
                                 FromSpherical(0.5, 0.1 * k), &value, k);
      ++k;
    }
  }
  return measurement;
}

TEST(GroupByIncidence, JitterAboutTheEdgeOfACellSplitsNothing) {
  // Where a grid of a tenth of a degree has its edges.
  const Measurement measurement = Lights({{11.25, 0}, {33.75, 0}, {56.25, 90}, {56.25, 180.05}}, 0.0005, 50);
  const Incidences incidences = GroupByIncidence(measurement);
  ASSERT_EQ(incidences.wi.size(), 4U);
  for (std::size_t i = 0; i < measurement.samples.size(); ++i) EXPECT_EQ(incidences.group[i], i % 4);
  EXPECT_NEAR(RadiansToDegrees(PolarAngle(incidences.wi[1])), 33.75, 1e-3);
  EXPECT_NEAR(RadiansToDegrees(Azimuth(incidences.wi[2])), 90, 1e-3);
}

TEST(GroupByIncidence, AzimuthsNearTheNormalAreNoDistance) {
  // A degree of azimuth at theta 1 degree is 0.017 degrees of arc.
  EXPECT_EQ(GroupByIncidence(Lights({{1, 0}}, 1e-9, 1)).wi.size(), 1U);
  Measurement measurement = Lights({}, 0, 0);
  const double value = 1;
  for (int k = 0; k < 100; ++k) {
    measurement.samples.Append(FromSpherical(DegreesToRadians(1), DegreesToRadians(std::sin(3.7 * k))),
                               FromSpherical(0.5, 0.1 * k), &value, static_cast<std::uint32_t>(k));
  }
  EXPECT_EQ(GroupByIncidence(measurement).wi.size(), 1U);
}

TEST(GroupByIncidence, AzimuthsOfMinusPiAndPiAreOneDirection) {
  EXPECT_EQ(GroupByIncidence(Lights({{40, 179.99}, {40, -179.99}}, 0, 3)).wi.size(), 1U);
}

// Every half degree of polar angle and 12 azimuths, up to grazing, jittered: as fine as the smallest resolution allows,
// so that a grid of cells that repeats itself holds many directions in one.
TEST(GroupByIncidence, FindsTheLightsOfAHemisphereWhateverTheResolution) {
  std::vector<std::pair<double, double>> lights;
  for (int t = 1; t < 180; ++t) {
    for (int p = 0; p < 12; ++p) lights.emplace_back(0.5 * t, 30 * p);
  }
  for (const double resolution_deg : {0.1, 1e-2, 1e-4}) {
    SCOPED_TRACE(resolution_deg);
    const Measurement measurement = Lights(lights, resolution_deg / 3, 3);
    const Incidences incidences = GroupByIncidence(measurement, DegreesToRadians(resolution_deg));
    ASSERT_EQ(incidences.wi.size(), lights.size());
    for (std::size_t i = 0; i < measurement.samples.size(); ++i) {
      ASSERT_EQ(incidences.group[i], incidences.group[i % lights.size()]);
      const Vec3 off = measurement.samples.wi(i) - incidences.wi[incidences.group[i]];
      ASSERT_LT(std::sqrt(Dot(off, off)), DegreesToRadians(resolution_deg));
    }
  }
}

TEST(GroupByIncidence, IncidencesOfAFifthOfADegreeStayApart) {
  std::vector<std::pair<double, double>> lights;
  for (int k = 0; k < 40; ++k) lights.emplace_back(10 + 0.2 * k, 30);
  EXPECT_EQ(GroupByIncidence(Lights(lights, 0.001, 5)).wi.size(), 40U);
}

TEST(GroupByIncidence, DirectionsThatFillAPartOfTheSphereAreNotOneChain) {
  // Every 0.05 degrees over 20: each is within the resolution of the next.
  std::vector<std::pair<double, double>> lights;
  for (int k = 0; k < 400; ++k) lights.emplace_back(20 + 0.05 * k, 0);
  EXPECT_GT(GroupByIncidence(Lights(lights, 0, 2)).wi.size(), 300U);
}

TEST(GroupByIncidence, OrderIsThatOfPolarAnglesThenAzimuths) {
  const Incidences incidences = GroupByIncidence(Lights({{50, 270}, {50, 90}, {20, 10}, {50, 0}}, 0.003, 20));
  ASSERT_EQ(incidences.wi.size(), 4U);
  const double expected[][2] = {{20, 10}, {50, 0}, {50, 90}, {50, -90}};
  for (std::size_t g = 0; g < 4; ++g) {
    EXPECT_NEAR(RadiansToDegrees(PolarAngle(incidences.wi[g])), expected[g][0], 0.01);
    EXPECT_NEAR(RadiansToDegrees(Azimuth(incidences.wi[g])), expected[g][1], 0.01);
  }
}

TEST(GroupByIncidence, IsByTheSideThatTheFileLists) {
  Measurement measurement = Lights({{10, 0}, {30, 0}}, 0, 20);
  EXPECT_EQ(GroupByIncidence(measurement).wi.size(), 2U);
  std::swap(measurement.samples.wi_x, measurement.samples.wo_x);
  std::swap(measurement.samples.wi_y, measurement.samples.wo_y);
  std::swap(measurement.samples.wi_z, measurement.samples.wo_z);
  EXPECT_GT(GroupByIncidence(measurement).wi.size(), 2U);
  measurement.listed_side = Beam::kViewer;
  EXPECT_EQ(GroupByIncidence(measurement).wi.size(), 2U);
  EXPECT_GT(GroupByDirection(measurement, Beam::kLight).wi.size(), 2U);
}

}  // namespace
}  // namespace lobefit
