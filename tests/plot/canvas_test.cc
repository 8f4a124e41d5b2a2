#include "lobefit/plot/canvas.h"

#include <cmath>

#include <gtest/gtest.h>

namespace lobefit {
namespace {

// Sum over the canvas of how much darker than white it is, in pixels of full black.
double Ink(const Canvas& canvas) {
  double sum = 0;
  for (int y = 0; y < canvas.pixels().rows; ++y) {
    for (int x = 0; x < canvas.pixels().cols; ++x) {
      const cv::Vec3b p = canvas.pixels().at<cv::Vec3b>(y, x);
      sum += (765 - p[0] - p[1] - p[2]) / 765.0;
    }
  }
  return sum;
}

std::shared_ptr<Fonts> SomeFonts() {
  static const auto fonts = std::make_shared<Fonts>();
  return fonts;
}

TEST(Canvas, ADiscCoversItsArea) {
  for (const double scale : {1.0, 2.0}) {
    Canvas canvas(40, 40, scale, SomeFonts());
    canvas.Disc({20.3, 19.8}, 9, {0, 0, 0});
    EXPECT_NEAR(Ink(canvas) / (scale * scale), 3.14159265 * 81, 1.0);
  }
}

TEST(Canvas, TransparencyMixes) {
  Canvas canvas(10, 10, 1, SomeFonts());
  canvas.Fill({0, 0, 10, 10}, {0, 0, 0}, 0.5);
  EXPECT_NEAR(canvas.pixels().at<cv::Vec3b>(5, 5)[0], 127, 1);
  canvas.Fill({0, 0, 10, 10}, {255, 0, 0}, 1);
  EXPECT_EQ(canvas.pixels().at<cv::Vec3b>(5, 5), cv::Vec3b(255, 0, 0));
}

TEST(Canvas, AThinLineIsOnePixelWhereverItLies) {
  for (const double y : {5.0, 5.25, 5.5, 5.9}) {
    Canvas canvas(20, 12, 1, SomeFonts());
    canvas.Line({2, y}, {18, y}, {{0, 0, 0}, 1});
    EXPECT_NEAR(Ink(canvas), 16, 1.5) << y;
  }
}

TEST(Canvas, DashesLeaveGaps) {
  Canvas solid(200, 10, 2, SomeFonts()), dashed(200, 10, 2, SomeFonts());
  solid.Line({10, 5}, {190, 5}, {{0, 0, 0}, 1});
  dashed.Line({10, 5}, {190, 5}, {{0, 0, 0}, 1, 1, 6, 6});
  EXPECT_GT(Ink(dashed), 0.4 * Ink(solid));
  EXPECT_LT(Ink(dashed), 0.75 * Ink(solid));
}

TEST(Canvas, APointThatIsNotFiniteBreaksTheLine) {
  Canvas canvas(30, 10, 1, SomeFonts());
  canvas.Polyline({{2, 5}, {10, 5}, {std::nan(""), 5}, {20, 5}, {28, 5}}, {{0, 0, 0}, 1});
  EXPECT_EQ(canvas.pixels().at<cv::Vec3b>(5, 15), cv::Vec3b(255, 255, 255));
  EXPECT_NE(canvas.pixels().at<cv::Vec3b>(5, 5), cv::Vec3b(255, 255, 255));
}

TEST(Canvas, ClipLimitsDrawingAndEnds) {
  Canvas canvas(20, 20, 1, SomeFonts());
  {
    const Canvas::Clip clip(&canvas, {5, 5, 10, 10});
    canvas.Fill({0, 0, 20, 20}, {0, 0, 0});
    canvas.Disc({10, 10}, 50, {0, 0, 0});
    canvas.Text({0, 12}, "WWWW", {.size = 20});
  }
  EXPECT_NEAR(Ink(canvas), 100, 1e-9);
  canvas.Fill({0, 0, 2, 2}, {0, 0, 0});
  EXPECT_NEAR(Ink(canvas), 104, 1e-9);
}

// Panels are drawn at the same time, each on its part of the page.
TEST(Canvas, APartDrawsOnThePageAndNowhereElse) {
  Canvas page(60, 20, 1, SomeFonts());
  const Canvas left = page.Part({0, 0, 30, 20});
  Canvas right = page.Part({30, 0, 30, 20});
  right.Fill({0, 0, 60, 20}, {0, 0, 0});
  EXPECT_NEAR(Ink(page), 30 * 20, 1e-9);
  EXPECT_NEAR(Ink(left), 30 * 20, 1e-9) << "one page, whichever part looks at it";
  EXPECT_EQ(page.pixels().at<cv::Vec3b>(5, 29), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(page.pixels().at<cv::Vec3b>(5, 30), cv::Vec3b(0, 0, 0));
  {
    const Canvas::Clip clip(&right, {0, 0, 40, 20});
    right.Fill({0, 0, 60, 20}, {255, 255, 255});
  }
  EXPECT_NEAR(Ink(page), 20 * 20, 1e-9) << "a clip within a part stays within it";
  page.Fill({0, 0, 60, 20}, {0, 0, 0});
  EXPECT_NEAR(Ink(page), 60 * 20, 1e-9);
}

// The coverage of a line is looked at in words of eight pixels: wherever it lies in them it has the same ink.
TEST(Canvas, ALineHasItsInkWhereverItBegins) {
  double first = 0;
  for (int shift = 0; shift < 9; ++shift) {
    Canvas canvas(60, 40, 1, SomeFonts());
    canvas.Polyline({{4.0 + shift, 3}, {44.0 + shift, 33}}, {{0, 0, 0}, 2});
    if (shift == 0) first = Ink(canvas);
    EXPECT_GT(first, 90);
    EXPECT_NEAR(Ink(canvas), first, 1e-9) << shift;
  }
}

TEST(Canvas, CoordinatesFarOutsideDoNoHarm) {
  Canvas canvas(20, 20, 2, SomeFonts());
  canvas.Polyline({{-1e12, 5}, {1e12, 5}}, {{0, 0, 0}, 1});
  canvas.Polygon({{-1e12, -1e12}, {1e12, -1e12}, {0, 1e12}}, {0, 0, 0});
  canvas.Disc({1e9, 1e9}, 3, {0, 0, 0});
  EXPECT_GT(Ink(canvas), 0);
}

class TextOf : public testing::TestWithParam<bool> {
 protected:
  std::shared_ptr<Fonts> FontsUnderTest() const {
    return GetParam() ? SomeFonts() : std::make_shared<Fonts>(std::vector<std::string>{"/nonexistent"});
  }
};

TEST_P(TextOf, WidthIsWhatIsDrawn) {
  const auto fonts = FontsUnderTest();
  if (GetParam() && !fonts->has_outlines()) GTEST_SKIP() << "DejaVu fonts are not installed";
  for (const char* text : {"θ_i = 30°", "in-plane curves", "10^{−3}", "naïve \xff bytes"}) {
    Canvas canvas(300, 40, 2, fonts);
    const TextStyle style = {.size = 14, .markup = true};
    canvas.Text({20, 25}, text, style);
    int left = 1 << 20, right = -1;
    for (int y = 0; y < canvas.pixels().rows; ++y) {
      for (int x = 0; x < canvas.pixels().cols; ++x) {
        if (canvas.pixels().at<cv::Vec3b>(y, x)[0] < 128) left = std::min(left, x), right = std::max(right, x);
      }
    }
    ASSERT_GE(right, 0) << text;
    EXPECT_GE(left, 2 * 20 - 3) << text;
    EXPECT_LE(right, 2 * (20 + canvas.TextWidth(text, style)) + 4) << text;
    EXPECT_GE(right, 2 * (20 + 0.9 * canvas.TextWidth(text, style)) - 12) << text;
  }
}

TEST_P(TextOf, ShortenAndWrapKeepToTheWidth) {
  Canvas canvas(10, 10, 2, FontsUnderTest());
  const TextStyle style = {.size = 12};
  const std::string path = "a_very_long_name_of_a_measurement_file_that_no_page_holds.csv";
  const std::string shorter = canvas.Shorten(path, style, 150, true);
  EXPECT_LE(canvas.TextWidth(shorter, style), 150);
  EXPECT_EQ(shorter.substr(0, 3), "a_v");
  EXPECT_EQ(shorter.substr(shorter.size() - 3), "csv");
  const std::vector<std::string> lines =
      canvas.Wrap("the rotation about the normal cannot be told from the data because both are equal", style, 150);
  EXPECT_GE(lines.size(), 3U);
  for (const std::string& line : lines) EXPECT_LE(canvas.TextWidth(line, style), 150) << line;
  EXPECT_EQ(lines[0].substr(0, 12), "the rotation");
}

INSTANTIATE_TEST_SUITE_P(Fonts, TextOf, testing::Bool(),
                         [](const auto& parameter) { return parameter.param ? "Outlines" : "Strokes"; });

}  // namespace
}  // namespace lobefit
