// The part of a measurement that is used: ranges of angles, whole turns, the normal.
#include "lobefit/measurement/prepare/selection.h"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

// Light at the normal, and at polar angles of 15 to 75 degrees at every 30 degrees of azimuth.
Measurement Lights() {
  MeasurementBuilder builder({{"Y"}, {}});
  const double value = 0.3;
  const Vec3 wo = FromSpherical(DegreesToRadians(20), 1);
  builder.Add({0, 0, 1}, wo, &value, 0);
  for (int theta = 15; theta <= 75; theta += 15) {
    for (int phi = 0; phi < 360; phi += 30)
      builder.Add(FromSpherical(DegreesToRadians(theta), DegreesToRadians(phi)), wo, &value, 0);
  }
  Measurement measurement = builder.Finish();
  measurement.source = "lights.csv";
  return measurement;
}

using Degrees = std::set<long>;

// Azimuths of [0, 360) that stay; the normal is not counted.
Degrees AzimuthsOf(const std::string& range) {
  Measurement m = Lights();
  Selection selection;
  selection.phi_i = ParseAngleRange(range, "--phi-i");
  const std::size_t before = m.samples.size();
  Apply(selection, &m);
  EXPECT_EQ(m.set_aside[SetAsideReason::kOutsideSelection], before - m.samples.size());
  EXPECT_EQ(m.samples.wi_z[0], 1) << "the normal has no azimuth";
  Degrees azimuths;
  for (std::size_t i = 1; i < m.samples.size(); ++i)
    azimuths.insert((std::lround(RadiansToDegrees(Azimuth(m.samples.wi(i)))) + 360) % 360);
  return azimuths;
}

TEST(Selection, AzimuthsAreTakenModuloATurn) {
  EXPECT_EQ(AzimuthsOf("30:90"), (Degrees{30, 60, 90}));
  EXPECT_EQ(AzimuthsOf("270"), (Degrees{270}));
  EXPECT_EQ(AzimuthsOf("-90"), (Degrees{270}));
  EXPECT_EQ(AzimuthsOf("630"), (Degrees{270}));
  EXPECT_EQ(AzimuthsOf("180"), (Degrees{180}));
  EXPECT_EQ(AzimuthsOf("-180"), (Degrees{180}));
  EXPECT_EQ(AzimuthsOf("-30:30"), (Degrees{0, 30, 330}));
  EXPECT_EQ(AzimuthsOf("330:390"), (Degrees{0, 30, 330}));
  EXPECT_EQ(AzimuthsOf("0:360").size(), 12U);
  EXPECT_EQ(AzimuthsOf("-180:180").size(), 12U);
  EXPECT_EQ(AzimuthsOf(":").size(), 12U);
}

// `lobefit info` lists azimuths of 0 to 360: a range of one bound is one of these, whatever the sign of the angle in
// the file.
TEST(Selection, OpenRangesOfAzimuthsEndWithTheTurn) {
  EXPECT_EQ(AzimuthsOf("200:"), (Degrees{210, 240, 270, 300, 330}));
  EXPECT_EQ(AzimuthsOf("180:"), (Degrees{180, 210, 240, 270, 300, 330}));
  EXPECT_EQ(AzimuthsOf(":90"), (Degrees{0, 30, 60, 90}));
  EXPECT_EQ(AzimuthsOf(":300"), (Degrees{0, 30, 60, 90, 120, 150, 180, 210, 240, 270, 300}));
  EXPECT_EQ(AzimuthsOf("0:").size(), 12U);
  EXPECT_EQ(AzimuthsOf("-60:"), (Degrees{0, 30, 60, 90, 120, 150, 180, 300, 330}));
  EXPECT_EQ(AzimuthsOf(":-60"), (Degrees{180, 210, 240, 270, 300}));
}

TEST(Selection, PolarAnglesAndTheLimit) {
  const auto left = [](const char* theta, double limit_deg) {
    Measurement m = Lights();
    Selection selection;
    if (*theta != '\0') selection.theta_i = ParseAngleRange(theta, "--theta-i");
    selection.theta_max = DegreesToRadians(limit_deg);
    const std::size_t before = m.samples.size();
    Apply(selection, &m);
    EXPECT_EQ(m.set_aside.total(), before - m.samples.size());
    return m.samples.size();
  };
  EXPECT_EQ(left("30", 90), 12U);
  EXPECT_EQ(left("30.04", 90), 12U) << "rounded to the steps of a goniometer";
  EXPECT_EQ(left("15:45", 90), 36U);
  EXPECT_EQ(left(":15", 90), 13U);
  EXPECT_EQ(left("60:", 90), 24U);
  EXPECT_EQ(left("", 60), 49U) << "at most: the limit itself is within";
  EXPECT_EQ(left("", 59.9), 37U);
  EXPECT_EQ(left("", 1e9), 61U);
  EXPECT_EQ(left("30:", 45), 24U);
  EXPECT_THROW(left("30.2", 90), InputError);
  EXPECT_THROW(left("", 19), InputError) << "the viewers are at 20 degrees";
}

TEST(Selection, NothingLeftNamesTheFileAndWhereToLook) {
  Measurement m = Lights();
  Selection selection;
  selection.theta_i = {1.5, 1.6};
  EXPECT_THAT(
      [&] { Apply(selection, &m); },
      ThrowsMessage<InputError>(HasSubstr("lights.csv: none of its 61 usable samples lies in the chosen part")));
}

TEST(ParseAngleRange, ReadsBoundsInDegrees) {
  const AngleRange range = ParseAngleRange(" 30 : 60.5 ", "--theta-i");
  EXPECT_DOUBLE_EQ(range.low, kPi / 6);
  EXPECT_DOUBLE_EQ(range.high, 60.5 * kPi / 180);
  EXPECT_EQ(ParseAngleRange(":60", "").low, -HUGE_VAL);
  EXPECT_EQ(ParseAngleRange("60:", "").high, HUGE_VAL);
  for (const char* bad : {"", "  ", "x", "30:x", "1:2:3", "nan", "inf:", "60:30", "30-60", "30deg"}) {
    EXPECT_THAT([&] { ParseAngleRange(bad, "--theta-i"); },
                ThrowsMessage<UsageError>(testing::AllOf(HasSubstr("--theta-i"), HasSubstr("write LOW:HIGH"))))
        << bad;
  }
}

}  // namespace
}  // namespace lobefit
