#include "lobefit/measurement/prepare/exclusion.h"

#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// Light at 30 degrees, viewers in its plane from -80 to 80 degrees; the value is the signed angle.
Measurement Scan() {
  MeasurementBuilder builder({{"Y"}, {}});
  for (int theta = -80; theta <= 80; theta += 5) {
    const double value = theta;
    builder.Add(FromSpherical(DegreesToRadians(30), 0), FromSpherical(DegreesToRadians(theta), kPi), &value, 1);
  }
  return builder.Finish();
}

std::size_t Excluded(const std::string& zones) {
  Measurement m = Scan();
  const std::size_t before = m.samples.size();
  Apply(ParseExclusions(zones), &m);
  EXPECT_EQ(m.set_aside[SetAsideReason::kOutsideSelection], before - m.samples.size());
  return before - m.samples.size();
}

TEST(Exclusion, ZonesHoldWhatTheySay) {
  EXPECT_EQ(Excluded("specular:5deg"), 3U);  // 25, 30, 35
  EXPECT_EQ(Excluded("retro:3"), 1U);        // -30
  EXPECT_EQ(Excluded("specular:0.18rad, retro:3"), 6U);
  EXPECT_EQ(Excluded("value<-70"), 2U);
  EXPECT_EQ(Excluded("value<=-70"), 3U);
  EXPECT_EQ(Excluded("value >= 80"), 1U);
  EXPECT_EQ(Excluded("theta-o>70"), 4U);
  EXPECT_EQ(Excluded("theta_o>=70"), 6U);
  EXPECT_EQ(Excluded("theta-o<5"), 1U);
  EXPECT_EQ(Excluded("theta-i>40"), 0U);
}

TEST(Exclusion, EachZoneIsCounted) {
  Measurement m = Scan();
  Apply(ParseExclusions("specular:5,value<-70"), &m);
  ASSERT_EQ(m.remarks.size(), 1U);
  EXPECT_EQ(m.remarks[0], "samples excluded: 3 near the mirror direction, 2 by their value");
  EXPECT_THROW(Apply(ParseExclusions("value<1000"), &m), InputError);
  for (const char* bad : {"", "specular", "specular:x", "mirror:5", "value:5", "theta-o>100", "retro:-1", "retro<3"})
    EXPECT_THROW(ParseExclusions(bad), UsageError) << bad;
}

}  // namespace
}  // namespace lobefit
