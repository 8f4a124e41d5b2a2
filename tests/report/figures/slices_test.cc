#include "lobefit/report/figures/slices.h"

#include <cmath>
#include <set>

#include "tests/report/synthetic.h"
#include <gtest/gtest.h>

namespace lobefit {
namespace {

Slices Gather(const Measurement& measurement) {
  return GatherSlices(measurement, GroupByStayingDirection(measurement));
}

TEST(Slices, OfAGoniometerFollowItsIncidentDirections) {
  const Measurement measurement = test::Measure(test::MakeMaterial(1, false), test::GoniometerPairs(true), 0, false);
  const Slices slices = Gather(measurement);
  EXPECT_FALSE(slices.outgoing_stays);
  EXPECT_FALSE(slices.gathered);
  EXPECT_EQ(slices.slices.size(), 12U);
  for (const Slice& slice : slices.slices) {
    EXPECT_GE(slice.points.size(), 80U);
    for (const SlicePoint& point : slice.points) {
      // The signed angle and the slice's directions give the sample back.
      Vec3 wi, wo;
      SliceDirections(slices, slice, point.theta, &wi, &wo);
      EXPECT_NEAR(Norm(wi - measurement.samples.wi(point.sample)), 0, 1e-6);
      EXPECT_NEAR(Norm(wo - measurement.samples.wo(point.sample)), 0, 0.01);
    }
  }
}

TEST(Slices, TheMirrorDirectionIsPositive) {
  const Measurement measurement = test::Measure(test::MakeMaterial(1, true), test::GoniometerPairs(false), 0, false);
  for (const Slice& slice : Gather(measurement).slices) {
    double brightest = 0, at = 0;
    for (const SlicePoint& point : slice.points) {
      const double value = measurement.samples.values[0][point.sample];
      if (slice.theta < 1 && value > brightest) brightest = value, at = point.theta;
    }
    if (slice.theta < 1) {
      EXPECT_NEAR(at, slice.theta, 0.12);
    }
  }
}

TEST(Slices, AMovingSourceAndAFixedDetectorGiveSlicesOfTheDetector) {
  test::Pairs pairs = test::GoniometerPairs(false);
  for (auto& [wi, wo] : pairs) std::swap(wi, wo);
  const Slices slices = Gather(test::Measure(test::MakeMaterial(1, true), pairs, 0, false));
  EXPECT_TRUE(slices.outgoing_stays);
  EXPECT_EQ(slices.slices.size(), 4U);
}

TEST(Slices, OfATableAreGatheredAtWholeDegreesWithThetaHKept) {
  const Measurement measurement = test::Measure(test::MakeMaterial(1, true), test::TablePairs(), 0, true);
  const Slices slices = Gather(measurement);
  EXPECT_TRUE(slices.gathered);
  EXPECT_GE(slices.slices.size(), 60U);
  for (const Slice& slice : slices.slices) {
    EXPECT_NEAR(RadiansToDegrees(slice.theta), std::round(RadiansToDegrees(slice.theta)), 1e-9);
    if (slice.theta < 0.1 || slice.theta > 1.2) continue;
    for (const SlicePoint& point : slice.points) {
      const Vec3 h = HalfVector(measurement.samples.wi(point.sample), measurement.samples.wo(point.sample));
      EXPECT_NEAR(std::fabs(point.theta - slice.theta) / 2, PolarAngle(h), 0.02 + slices.tolerance);
    }
  }
}

TEST(ChooseSlices, TakesARowForEachAzimuthAndSpreadsPolarAngles) {
  const Measurement measurement = test::Measure(test::MakeMaterial(1, false), test::GoniometerPairs(true), 0, false);
  const Slices slices = Gather(measurement);
  std::size_t rows = 0, columns = 0;
  const std::vector<const Slice*> chosen = ChooseSlices(slices, 3, 3, &rows, &columns);
  EXPECT_EQ(rows, 3U);
  EXPECT_EQ(columns, 3U);
  ASSERT_EQ(chosen.size(), 9U);
  std::set<long> angles;
  for (const Slice* slice : chosen) {
    ASSERT_NE(slice, nullptr);
    angles.insert(std::lround(RadiansToDegrees(slice->theta)));
  }
  EXPECT_TRUE(angles.count(10) == 1 && angles.count(70) == 1);
}

TEST(ChooseSlices, NothingComesOfNothing) {
  std::size_t rows = 1, columns = 1;
  EXPECT_TRUE(ChooseSlices({}, 3, 3, &rows, &columns).empty());
  EXPECT_EQ(rows, 0U);
}

}  // namespace
}  // namespace lobefit
