// Near lights are fitted as such; near lights taken as distant and a wrong encoding are noticed.
#include "tests/maps/texels.h"
#include "tests/support/folder_test.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/maps/report/relit_error.h"
#include "lobefit/maps/run.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class Doubts : public FolderTest {
 protected:
  static constexpr std::size_t kSide = 24;

  // Photographs of hills by 40 lights that many widths away; 0: far.
  Stack Photographed(double distance, double noise) {
    hills_ = MakeHills(kSide, MapLobe::kGgx, 0.6);
    StackSynthesis synthesis;
    synthesis.lights = DomeLights(40, 60 * kPi / 180);
    synthesis.distance = distance;
    synthesis.noise.multiplicative = noise;
    synthesis.bits = noise > 0 ? 16 : 32;
    WriteStack(hills_.maps, synthesis, folder_ / "s");
    return OpenStack(folder_ / "s", {});
  }
  Maps Fitted(const Stack& stack) const {
    MapsOptions options;
    options.recipe.rules.schlick = stack.calibrated;
    options.folder = folder_, options.name = "fit";
    RunMaps(stack, options, "");
    return ReadMapsExr(folder_ / "fit.maps.exr");
  }
  StackDoubts Of(const Maps& maps, const Stack& stack) const {
    const StackDoubts doubts = JudgeLights(maps, stack, {}, MedianFallback(maps)).doubts;
    std::printf("  exponent %.4f +- %.2g, nearness %.4f +- %.2g, bend %.3f\n", 1 + doubts.exponent.value,
                doubts.exponent.error, doubts.nearness.value, doubts.nearness.error, doubts.bend);
    return doubts;
  }
  // Mean over the texels, radians.
  double NormalError(const Maps& maps) const {
    double sum = 0, count = 0;
    for (std::size_t t = 0; t < kSide * kSide; ++t) {
      const double angle = test::AngleBetween(test::NormalAt(maps, t), test::NormalAt(hills_.maps, t));
      if (std::isfinite(angle)) sum += angle, ++count;
    }
    return sum / count;
  }

  Hills hills_;
};

TEST_F(Doubts, NearLightsAreFittedAsSuch) {
  const Stack stack = Photographed(1.5, 0);
  ASSERT_TRUE(stack.near.has_value());
  const Maps maps = Fitted(stack);
  for (std::size_t t = 0; t < kSide * kSide; ++t) {
    EXPECT_LT(test::AngleBetween(test::NormalAt(maps, t), test::NormalAt(hills_.maps, t)), 1e-5) << t;
    const double alpha = test::At(hills_.maps, MapPart::kParameters, "alpha", t);
    if (std::isnan(alpha)) continue;
    EXPECT_NEAR(test::At(maps, MapPart::kParameters, "alpha", t), alpha, 1e-5) << t;
    EXPECT_NEAR(test::At(maps, MapPart::kParameters, "f0.R", t), test::At(hills_.maps, MapPart::kParameters, "f0.R", t),
                1e-5);
  }
}

TEST_F(Doubts, RightStacksRaiseNone) {
  const Stack stack = Photographed(0, 0.01);
  EXPECT_THAT(Of(Fitted(stack), stack).Remarks(), IsEmpty());
}

TEST_F(Doubts, NearLightsTakenAsDistantAreReportedWithTheirBias) {
  Stack stack = Photographed(4, 0.01);
  stack.near.reset();
  const Maps maps = Fitted(stack);
  const StackDoubts doubts = Of(maps, stack);
  const double bias = doubts.nearness.value * doubts.bend, error = NormalError(maps);
  std::printf("  bias %.4f, mean error of the normals %.4f\n", bias, error);
  EXPECT_NEAR(doubts.nearness.value, 0.25, 0.06);
  EXPECT_NEAR(bias, error, 0.3 * error);
  ASSERT_FALSE(doubts.Remarks().empty());
  EXPECT_THAT(doubts.Remarks().back(), HasSubstr("widths of the picture away"));
}

TEST_F(Doubts, AWrongEncodingIsNoticed) {
  Stack stack = Photographed(0, 0.01);
  for (const char* encoding : {"srgb", "gamma:0.4545"}) {
    ReadEncoding(encoding, "test", &stack.response);
    const StackDoubts doubts = Of(Fitted(stack), stack);
    ASSERT_FALSE(doubts.Remarks().empty()) << encoding;
    EXPECT_THAT(doubts.Remarks()[0], HasSubstr("as a wrong encoding makes them")) << encoding;
    // Decoded twice, or not at all.
    EXPECT_EQ(doubts.exponent.value > 0, std::string(encoding) == "srgb");
  }
}

}  // namespace
}  // namespace lobefit
