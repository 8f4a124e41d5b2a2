#include "lobefit/plot/color.h"

#include <cmath>

#include <gtest/gtest.h>

namespace lobefit {
namespace {

TEST(ToScreen, IsTheSrgbCurveUpToTheShoulder) {
  // Grey of 18 % and the linear foot, by hand: 1.055 x^(1/2.4) - 0.055 and 12.92 x.
  EXPECT_EQ(ToScreen({0.18, 0.18, 0.18}, 1), (Rgb{118, 118, 118}));
  EXPECT_EQ(ToScreen({0.003, 0.003, 0.003}, 1).r, std::lround(255 * 12.92 * 0.003));
  EXPECT_EQ(ToScreen({0.09, 0.06, 0.03}, 2), ToScreen({0.18, 0.12, 0.06}, 1)) << "exposure is a factor";
}

TEST(ToScreen, RisesToWhiteAndNoFurther) {
  int last = 0;
  for (double v = 0; v < 4; v += 0.01) {
    const int shown = ToScreen({v, 0, 0}, 1).r;
    ASSERT_GE(shown, last) << v;
    last = shown;
  }
  EXPECT_EQ(last, 255);
  EXPECT_EQ(ToScreen({-1, 0, 1e9}, 1), (Rgb{0, 0, 255}));
  // The shoulder keeps light above 1 apart from white.
  EXPECT_LT(ToScreen({1, 1, 1}, 1).r, 255);
}

TEST(ChannelColor, IsLinearInItsChannels) {
  for (const Channels& channels : {Channels{{"R", "G", "B"}, {}}, Channels{{"Y"}, {}}, Channels{{"X", "Y", "Z"}, {}},
                                   Channels{{"450nm", "550nm", "610nm", "680nm"}, {450, 550, 610, 680}}}) {
    const ChannelColor color(channels);
    std::vector<double> values(channels.size());
    std::array<double, 3> expected = {0, 0, 0};
    for (std::size_t c = 0; c < values.size(); ++c) {
      values[c] = 0.2 + 0.3 * static_cast<double>(c);
      for (std::size_t k = 0; k < 3; ++k) expected[k] += values[c] * color.OfChannel(c)[k];
    }
    const std::array<double, 3> found = color.Linear(values.data());
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], 1e-14) << channels.names[0];
  }
}

TEST(ChannelColor, ShowsInfraredAsGrey) {
  const ChannelColor color({{"1064nm", "1550nm"}, {1064, 1550}});
  const double values[] = {0.2, 0.6};
  for (const double v : color.Linear(values)) EXPECT_NEAR(v, 0.4, 1e-15);
}

TEST(ChannelColor, OfRgbIsItself) {
  const ChannelColor color({{"R", "G", "B"}, {}});
  const double values[] = {0.1, 0.5, 0.9};
  EXPECT_EQ(color.Linear(values), (std::array<double, 3>{0.1, 0.5, 0.9}));
}

}  // namespace
}  // namespace lobefit
