// Tilts and turns that the data do not tell apart from none.
#include "lobefit/export/determined.h"

#include <cmath>

#include "tests/export/materials.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/export/targets.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

using testing::HasSubstr;

// Angles in degrees with one error for all.
Material Fitted(double theta_x, double theta_y, double theta_z, double error_deg) {
  Material material = test::MaterialOf(OneLobe(Ndf::kEllipsoid, 0.3, 0.2, theta_x, theta_y, theta_z));
  for (std::size_t p = 2; p < 5; ++p) {
    material.parameters[p].standard_error = {DegreesToRadians(error_deg) / 3};  // the clustered one counts
    material.parameters[p].standard_error_clustered = {DegreesToRadians(error_deg)};
  }
  return material;
}

TEST(OnlyDetermined, LeavesOutATiltWithinItsError) {
  const Determined within = OnlyDetermined(Fitted(0.006, 0.02, 40, 0.03));
  ASSERT_EQ(within.left_out.size(), 1U);
  EXPECT_EQ(within.left_out[0].feature, Feature::kTilt);
  EXPECT_EQ(within.left_out[0].how, Carries::kNot);
  EXPECT_THAT(within.left_out[0].note, HasSubstr("0.021 degrees, within twice its error of 0.03 degrees"));
  EXPECT_FALSE(FittedBrdf(within.material).IsTilted());
  EXPECT_NEAR(within.material.parameters[4].values[0], DegreesToRadians(40), 1e-15) << "the turn stays";

  const Determined beyond = OnlyDetermined(Fitted(0.006, 0.07, 40, 0.03));
  EXPECT_TRUE(beyond.left_out.empty());
  EXPECT_TRUE(FittedBrdf(beyond.material).IsTilted());
}

TEST(OnlyDetermined, KeepsWhatWasGiven) {
  Material given = Fitted(0.006, 0.02, 0.1, 0.03);
  for (FittedParameter& parameter : given.parameters) {
    parameter.free = false;
    parameter.standard_error = parameter.standard_error_clustered = {std::nan("")};
  }
  EXPECT_TRUE(OnlyDetermined(given).left_out.empty());
}

TEST(OnlyDetermined, LeavesOutATurn) {
  const Determined small = OnlyDetermined(Fitted(5, 5, 0.5, 0.4));
  ASSERT_EQ(small.left_out.size(), 1U);
  EXPECT_EQ(small.left_out[0].feature, Feature::kRotation);
  EXPECT_EQ(small.material.parameters[4].values[0], 0);
  EXPECT_EQ(small.material.parameters[0].values[0], 0.3) << "the widths stay";

  Material round = Fitted(5, 5, 20, 0.4);
  round.parameters[4].standard_error = round.parameters[4].standard_error_clustered = {std::nan("")};
  const Determined undetermined = OnlyDetermined(round);
  ASSERT_EQ(undetermined.left_out.size(), 1U);
  EXPECT_THAT(undetermined.left_out[0].note, HasSubstr("written as round"));
  EXPECT_NEAR(undetermined.material.parameters[0].values[0], std::sqrt(0.06), 1e-15);
  EXPECT_EQ(undetermined.material.parameters[1].values, undetermined.material.parameters[0].values);
}

// A MERL table has no tilt: one within its error does not keep a material out of it.
TEST(OnlyDetermined, IsWhatTargetsAreGiven) {
  Material material = Fitted(0.006, 0, 0, 0.024);
  material.parameters[1].values = material.parameters[0].values;
  EXPECT_FALSE(FindTarget("merl").refusal(FittedBrdf(material)).empty());
  EXPECT_EQ(FindTarget("merl").refusal(FittedBrdf(OnlyDetermined(material).material)), "");
}

}  // namespace
}  // namespace lobefit
