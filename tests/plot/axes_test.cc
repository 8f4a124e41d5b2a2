#include "lobefit/plot/axes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lobefit/plot/style.h"

namespace lobefit {
namespace {

std::vector<std::string> Labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> labels;
  for (const Tick& tick : ticks) {
    if (!tick.label.empty()) labels.push_back(tick.label);
  }
  return labels;
}

TEST(LinearTicks, StandAtRoundNumbersWithinTheRange) {
  EXPECT_EQ(Labels(LinearTicks(0, 1, 5)), (std::vector<std::string>{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(Labels(LinearTicks(-0.13, 0.13, 5)), (std::vector<std::string>{"−0.1", "0.0", "0.1"}));
  EXPECT_EQ(Labels(LinearTicks(-0.0041, 0.0041, 4)),
            (std::vector<std::string>{"−0.004", "−0.002", "0.000", "0.002", "0.004"}));  // not 0 alone
  EXPECT_EQ(Labels(LinearTicks(0, 3000, 3)), (std::vector<std::string>{"0", "1000", "2000", "3000"}));
  for (const double span : {1e-6, 0.37, 12.0, 8.1e5}) {
    const std::vector<Tick> ticks = LinearTicks(-span / 3, span, 5);
    EXPECT_GE(ticks.size(), 2U) << span;
    EXPECT_LE(ticks.size(), 9U) << span;
    for (const Tick& tick : ticks)
      EXPECT_TRUE(tick.value >= -span / 3 * (1 + 1e-9) && tick.value <= span * (1 + 1e-9)) << span;
  }
}

TEST(LinearTicks, AnEmptyRangeHasOneTick) { EXPECT_EQ(LinearTicks(2, 2, 5).size(), 1U); }

TEST(AngleTicks, TakeStepsOfADial) {
  EXPECT_EQ(Labels(AngleTicks(-90, 90, 6)), (std::vector<std::string>{"−90", "−60", "−30", "0", "30", "60", "90"}));
  EXPECT_EQ(Labels(AngleTicks(0, 90, 4)), (std::vector<std::string>{"0", "30", "60", "90"}));
  EXPECT_EQ(Labels(AngleTicks(0, 45, 3)), (std::vector<std::string>{"0", "15", "30", "45"}));
}

TEST(LogTicks, LabelPowersOfTenAndSkipAsNeeded) {
  EXPECT_EQ(Labels(LogTicks(1e-3, 1e3, 8)),
            (std::vector<std::string>{"10^{−3}", "10^{−2}", "10^{−1}", "1", "10", "10^{2}", "10^{3}"}));
  EXPECT_EQ(Labels(LogTicks(1e-3, 1e3, 3)), (std::vector<std::string>{"10^{−2}", "1", "10^{2}"}));
}

TEST(LogTicks, AShortRangeLabelsDigits) {
  EXPECT_EQ(Labels(LogTicks(1, 20, 5)), (std::vector<std::string>{"1", "2", "5", "10", "20"}));
  EXPECT_EQ(Labels(LogTicks(0.02, 0.05, 5)), (std::vector<std::string>{"0.02", "0.03", "0.04", "0.05"}));
}

TEST(LogRangeAround, HoldsTheValuesAtRoundEnds) {
  for (const auto& [low, high] : {std::pair{0.3, 0.7}, {1.0, 1.0}, {0.011, 9.0}, {3e-5, 4e3}, {2.0, 20.0}}) {
    const Range range = LogRangeAround(low, high);
    EXPECT_LE(range.low, low * (1 + 1e-9));
    EXPECT_GE(range.high, high * (1 - 1e-9));
    EXPECT_LT(range.low, range.high);
    EXPECT_LE(range.high / range.low, 101 * high / low);
  }
}

TEST(Axes, MapEndsToTheFrame) {
  const Axes axes({10, 20, 100, 50}, {-1, 3, false}, {0.1, 1000, true});
  EXPECT_DOUBLE_EQ(axes.MapX(-1), 10);
  EXPECT_DOUBLE_EQ(axes.MapX(1), 60);
  EXPECT_DOUBLE_EQ(axes.MapY(0.1), 70);
  EXPECT_NEAR(axes.MapY(10), 45, 1e-9);
  EXPECT_DOUBLE_EQ(axes.MapY(1000), 20);
}

TEST(Number, IsShortAndHonest) {
  EXPECT_EQ(Number(0.12345), "0.123");
  EXPECT_EQ(Number(0.09996), "0.100");
  EXPECT_EQ(Number(-3.14159, 4), "−3.142");
  EXPECT_EQ(Number(0), "0");
  EXPECT_EQ(Number(1234.5), "1234");
  EXPECT_EQ(Number(1.5e-7), "1.50·10^{−7}");
  EXPECT_EQ(Number(9.999e-7), "1.00·10^{−6}");
  EXPECT_EQ(Number(std::nan("")), "–");
}

TEST(RoundToError, KeepsTwoDigitsOfTheError) {
  EXPECT_EQ(RoundToError(0.183449, 0.00123).value, "0.1834");
  EXPECT_EQ(RoundToError(0.183449, 0.00123).error, "0.0012");
  EXPECT_EQ(RoundToError(0.5, 0.0996).value, "0.50");
  EXPECT_EQ(RoundToError(0.5, 0.0996).error, "0.10");
  EXPECT_EQ(RoundToError(123.456, 7).value, "123.5");
  EXPECT_EQ(RoundToError(0.25, std::nan("")).error, "");
}

TEST(RatioText, NamesPercentNearOneAndFactorsBeyond) {
  EXPECT_EQ(RatioText(1), "1");
  EXPECT_EQ(RatioText(1.2), "+20%");
  EXPECT_EQ(RatioText(1 / 1.2), "−17%");
  EXPECT_EQ(RatioText(3), "×3");
  EXPECT_EQ(RatioText(1.0 / 3), "÷3");
}

TEST(Count, GroupsThousands) {
  EXPECT_EQ(Count(7), "7");
  EXPECT_EQ(Count(1458000), "1\u2009458\u2009000");
}

// Relative luminance of an sRGB colour, WCAG 2.
double Luminance(const Rgb& color) {
  const auto linear = [](int v) {
    const double s = v / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(color.r) + 0.7152 * linear(color.g) + 0.0722 * linear(color.b);
}

TEST(SequentialColor, RisesInLuminance) {
  for (int k = 1; k <= 100; ++k)
    EXPECT_GT(Luminance(SequentialColor(k / 100.0)), Luminance(SequentialColor((k - 1) / 100.0))) << k;
}

TEST(DivergingColor, IsBrightestInTheMiddle) {
  for (int k = 1; k <= 50; ++k) {
    EXPECT_GE(Luminance(DivergingColor(k / 100.0)), Luminance(DivergingColor((k - 1) / 100.0))) << k;
    EXPECT_LE(Luminance(DivergingColor(0.5 + k / 100.0)), Luminance(DivergingColor(0.5 + (k - 1) / 100.0))) << k;
  }
}

TEST(Text, StandsOutFromThePage) {
  for (const Rgb color : {style::kInk, style::kSecondary, style::kWarning})
    EXPECT_GT(1.05 / (Luminance(color) + 0.05), 4.5);
}

}  // namespace
}  // namespace lobefit
