// Pictures in a picture, rings, boxes, and the words of tables and axes.
#include <cmath>
#include <set>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "lobefit/math/vec.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/canvas.h"
#include "lobefit/plot/style.h"
#include "lobefit/plot/table.h"

namespace lobefit {
namespace {

const std::shared_ptr<Fonts>& PictureFonts() {
  static const auto fonts = std::make_shared<Fonts>();
  return fonts;
}

cv::Vec3b At(const Canvas& canvas, int x, int y) { return canvas.pixels().at<cv::Vec3b>(y, x); }

bool IsPaper(const Canvas& canvas, int x, int y) { return At(canvas, x, y) == cv::Vec3b(255, 255, 255); }

// Each pixel a rectangle: red, green / blue, black over a box of 8 x 6 pixels.
TEST(Image, PixelsAreRectanglesInTheirBox) {
  cv::Mat image(2, 2, CV_8UC3);
  image.at<cv::Vec3b>(0, 0) = {255, 0, 0};
  image.at<cv::Vec3b>(0, 1) = {0, 255, 0};
  image.at<cv::Vec3b>(1, 0) = {0, 0, 255};
  image.at<cv::Vec3b>(1, 1) = {0, 0, 0};
  for (const int scale : {1, 2}) {
    Canvas canvas(20, 20, scale, PictureFonts());
    canvas.Image(image, {4, 6, 8, 6}, false);
    for (int y = 0; y < 20 * scale; ++y) {
      for (int x = 0; x < 20 * scale; ++x) {
        const bool inside = x >= 4 * scale && x < 12 * scale && y >= 6 * scale && y < 12 * scale;
        const cv::Vec3b expected =
            inside ? image.at<cv::Vec3b>(y < 9 * scale ? 0 : 1, x < 8 * scale ? 0 : 1) : cv::Vec3b(255, 255, 255);
        ASSERT_EQ(At(canvas, x, y), expected) << x << " " << y << " at scale " << scale;
      }
    }
  }
}

// A large picture in a small box is averaged; what is transparent shows the paper; what lies outside is cut.
TEST(Image, IsAveragedMixedAndCut) {
  cv::Mat checks(64, 64, CV_8UC4);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const std::uint8_t level = (x + y) % 2 == 0 ? 0 : 200;
      checks.at<cv::Vec4b>(y, x) = {level, level, level, static_cast<std::uint8_t>(x < 32 ? 255 : 0)};
    }
  }
  Canvas canvas(24, 24, 1, PictureFonts());
  canvas.Image(checks, {4, 4, 16, 16}, true);
  for (int y = 6; y < 18; ++y) {
    EXPECT_NEAR(At(canvas, 7, y)[0], 100, 2) << "the mean of 0 and 200";
    EXPECT_TRUE(IsPaper(canvas, 16, y));
  }
  for (const Box& box : {Box{-10, -10, 16, 16}, Box{20, 20, 16, 16}, Box{100, 100, 5, 5}, Box{3, 3, 0, 0}})
    canvas.Image(checks, box, true);
  EXPECT_NEAR(At(canvas, 0, 0)[0], 255, 155);
  EXPECT_TRUE(IsPaper(canvas, 12, 2));
}

// A ring has the area of its band, and nothing within.
TEST(Ring, CoversItsBand) {
  for (const double scale : {1.0, 3.0}) {
    Canvas canvas(60, 60, scale, PictureFonts());
    canvas.Ring({30.2, 29.7}, 20, {.color = {0, 0, 0}, .width = 3});
    double ink = 0;
    for (int y = 0; y < canvas.pixels().rows; ++y) {
      for (int x = 0; x < canvas.pixels().cols; ++x) {
        const double dark = (255 - At(canvas, x, y)[0]) / 255.0;
        ink += dark;
        const double r = std::hypot((x + 0.5) / scale - 30.2, (y + 0.5) / scale - 29.7);
        if (r < 17 || r > 23) {
          ASSERT_EQ(dark, 0);
        }
      }
    }
    EXPECT_NEAR(ink / (scale * scale), 2 * kPi * 20 * 3, 3);
  }
}

TEST(Inset, TakesTheBorderAway) {
  const Box box = Inset({10, 20, 100, 50}, 1, 2, 3, 4);
  EXPECT_EQ(std::tie(box.x, box.y), std::make_tuple(11, 22));
  EXPECT_EQ(box.right(), 107);
  EXPECT_EQ(box.bottom(), 66);
  EXPECT_EQ(box.center().x, 59);
}

// The colours of a scale stand under the ticks that name their values.
TEST(ColorScale, TicksStandAtTheirColours) {
  Canvas canvas(220, 60, 2, PictureFonts());
  const Box box = {10, 20, 200, 10};
  DrawColorScale(&canvas, box, SequentialColor, {1, 100, true}, {}, "");
  for (const double t : {0.1, 0.5, 0.9}) {
    const cv::Vec3b pixel = At(canvas, static_cast<int>(2 * (box.x + t * box.width)), 50);
    const Rgb expected = SequentialColor(t);
    EXPECT_NEAR(pixel[0], expected.r, 4);
    EXPECT_NEAR(pixel[1], expected.g, 4);
    EXPECT_NEAR(pixel[2], expected.b, 4);
  }
}

// Grid lines and frame stay within the frame and its tick marks; data are mapped to where the ticks stand.
TEST(Axes, GridLinesStandAtTheirTicks) {
  Canvas canvas(120, 120, 1, PictureFonts());
  const Axes axes({20, 20, 80, 80}, {0, 8, false}, {1, 1e4, true});
  axes.DrawGrid(&canvas, {{2, "2"}, {6, "6"}}, {{10, "10"}});
  EXPECT_FALSE(IsPaper(canvas, 40, 30) && IsPaper(canvas, 39, 30));
  EXPECT_FALSE(IsPaper(canvas, 80, 30) && IsPaper(canvas, 79, 30));
  EXPECT_FALSE(IsPaper(canvas, 30, 80) && IsPaper(canvas, 30, 79)) << "a quarter of the way up";
  EXPECT_TRUE(IsPaper(canvas, 60, 30) && IsPaper(canvas, 30, 40) && IsPaper(canvas, 10, 80));
}

TEST(Degrees, AreShort) {
  EXPECT_EQ(Degrees(kPi / 6), "30°");
  EXPECT_EQ(Degrees(DegreesToRadians(2.54)), "2.5°");
  EXPECT_EQ(Degrees(0), "0°");
  EXPECT_EQ(Degrees(DegreesToRadians(29.9999999)), "30°");
  EXPECT_EQ(Degrees(-kPi / 4), "−45°") << "with a real minus sign";
  EXPECT_EQ(Degrees(-1e-9), "0°") << "no minus before nothing";
}

TEST(ChannelColors, AreToldApart) {
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"R", "G", "B"}, {"X", "Y", "Z"}, {"a", "b", "c", "d", "e"}}) {
    const std::vector<Rgb> colors = ChannelColors(names);
    ASSERT_EQ(colors.size(), names.size());
    std::set<std::tuple<int, int, int>> different;
    for (const Rgb c : colors) different.insert({c.r, c.g, c.b});
    EXPECT_EQ(different.size(), names.size()) << names[0];
  }
  const std::vector<Rgb> rgb = ChannelColors({"R", "G", "B"});
  EXPECT_TRUE(rgb[0].r > rgb[0].g && rgb[0].r > rgb[0].b);
  EXPECT_TRUE(rgb[1].g > rgb[1].r && rgb[1].g > rgb[1].b);
  EXPECT_TRUE(rgb[2].b > rgb[2].r && rgb[2].b > rgb[2].g);
  EXPECT_EQ(ChannelColors({}).size(), 0U);
  EXPECT_EQ(ChannelColors(std::vector<std::string>(200, "c")).size(), 200U);
}

TEST(Symbol, OfEveryParameterIsWithoutItsLobe) {
  Model model;
  model.lobes = {Lobe{Ndf::kEllipsoid, Masking::kSmithSeparable, Fresnel::kSchlick},
                 Lobe{Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kConductor}};
  std::size_t of_second = 0;
  for (const Parameter& parameter : Parameters(model)) {
    const bool second = parameter.name.starts_with("lobe2.");
    of_second += LobeOf(parameter);
    EXPECT_EQ(LobeOf(parameter), second ? 1U : 0U) << parameter.name;
    EXPECT_EQ(Symbol(parameter).find('.'), std::string::npos) << parameter.name;
    EXPECT_NE(Symbol(parameter), "") << parameter.name;
  }
  EXPECT_GT(of_second, 0U);
  EXPECT_EQ(Symbol(Parameters(model)[0]), "α_x");
}

}  // namespace
}  // namespace lobefit
