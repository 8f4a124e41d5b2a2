// Pictures of two angles: what is near samples, common scales, discs.
#include "lobefit/report/figures/field_image.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "lobefit/math/vec.h"
#include "lobefit/plot/style.h"

namespace lobefit {
namespace {

int Brightness(Rgb c) { return c.r + c.g + c.b; }

TEST(FieldImage, StartsUnknown) {
  const FieldImage image(5, 3);
  ASSERT_EQ(image.measured.size(), 15U);
  for (const auto* values : {&image.measured, &image.fitted, &image.log_ratio}) {
    for (const float v : *values) EXPECT_TRUE(std::isnan(v));
  }
  EXPECT_EQ(image.At(4, 2), 14U);
}

// A closing of the mask: places that are near stay, holes of a few pixels are filled, wide ones are not.
TEST(KeepNear, FillsSmallHolesAlone) {
  constexpr int kSide = 60;
  FieldImage image(kSide, kSide);
  std::vector<std::uint8_t> near(image.measured.size(), 1);
  const auto block = [&](int column, int row, int side) {
    for (int y = row; y < row + side; ++y) {
      for (int x = column; x < column + side; ++x) near[image.At(x, y)] = 0;
    }
  };
  block(8, 8, 4);
  block(30, 30, 24);
  std::fill(image.measured.begin(), image.measured.end(), 1.0F);
  std::fill(image.fitted.begin(), image.fitted.end(), 2.0F);
  std::fill(image.log_ratio.begin(), image.log_ratio.end(), -0.7F);
  const int left = KeepNear(near, &image);
  EXPECT_EQ(image.measured[image.At(9, 9)], 1) << "a gap between samples";
  EXPECT_TRUE(std::isnan(image.measured[image.At(42, 42)])) << "far from all samples";
  int known = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    known += std::isnan(image.measured[i]) ? 0 : 1;
    EXPECT_EQ(std::isnan(image.measured[i]), std::isnan(image.log_ratio[i]));
    EXPECT_EQ(image.fitted[i], 2) << "the fit is known everywhere";
    if (near[i] != 0) {
      EXPECT_FALSE(std::isnan(image.measured[i]));
    }
  }
  EXPECT_EQ(left, known);
  EXPECT_LE(known, kSide * kSide - 16 * 16);
}

TEST(LogRatio, IsBounded) {
  EXPECT_FLOAT_EQ(LogRatioOf(2, 1), std::log(2.0F));
  EXPECT_EQ(LogRatioOf(1e30, 1), kMostLogRatio);
  EXPECT_EQ(LogRatioOf(1, 1e30), -kMostLogRatio);
  for (const double none : {0.0, -1.0, std::nan("")}) {
    EXPECT_EQ(LogRatioOf(none, 1), -kMostLogRatio);
    EXPECT_EQ(LogRatioOf(1, none), -kMostLogRatio);
  }
}

FieldImage Random(float scale, float spread, unsigned seed) {
  FieldImage image(120, 90);
  std::mt19937 engine(seed);
  for (std::size_t i = 0; i < image.measured.size(); ++i) {
    image.fitted[i] = scale * std::exp(std::normal_distribution<float>(0, 2)(engine));
    image.log_ratio[i] = std::normal_distribution<float>(0, spread)(engine);
    image.measured[i] = image.fitted[i] * std::exp(image.log_ratio[i]);
  }
  return image;
}

// Larger values are never darker; nothing is the grey of nothing; ratios of 1 stand in the middle, both sides differ.
TEST(FieldScale, ColoursFollowValues) {
  const FieldImage image = Random(0.01F, 0.3F, 1);
  const FieldScale scale({&image});
  const Rgb nothing = scale.ValueColor(std::nanf(""));
  EXPECT_EQ(Brightness(nothing), Brightness(style::kGrid));
  EXPECT_EQ(Brightness(scale.RatioColor(std::nanf(""))), Brightness(style::kGrid));
  const int darkest = Brightness(scale.ValueColor(0)), brightest = Brightness(scale.ValueColor(1e30F));
  EXPECT_NE(darkest, brightest);
  const int direction = brightest > darkest ? 1 : -1;
  int last = darkest;
  for (float v = 1e-6F; v < 10; v *= 1.3F) {
    const int now = Brightness(scale.ValueColor(v));
    EXPECT_GE(direction * (now - last), -8) << v;
    last = now;
  }
  EXPECT_EQ(Brightness(scale.ValueColor(-1)), darkest);
  EXPECT_EQ(last, brightest);
  const Rgb more = scale.RatioColor(4), less = scale.RatioColor(-4), equal = scale.RatioColor(0);
  EXPECT_TRUE(more.r != less.r || more.b != less.b);
  EXPECT_TRUE(Brightness(equal) > Brightness(more) && Brightness(equal) > Brightness(less));
}

// A ratio scale holds 90 % of the ratios and none that is much smaller does.
TEST(FieldScale, RatiosAreHeld) {
  for (const float spread : {0.01F, 0.08F, 0.3F, 1.0F}) {
    const FieldImage image = Random(1, spread, 2);
    const FieldScale scale({&image});
    int beyond = 0, all = 0;
    const Rgb most = scale.RatioColor(kMostLogRatio), least = scale.RatioColor(-kMostLogRatio);
    for (const float r : image.log_ratio) {
      const Rgb c = scale.RatioColor(r);
      const auto same = [&](Rgb d) { return c.r == d.r && c.g == d.g && c.b == d.b; };
      beyond += same(most) || same(least) ? 1 : 0;
      ++all;
    }
    EXPECT_LT(beyond, 0.14 * all) << spread;
  }
}

// Pictures without a positive value have scales that can be drawn, and a single bright pixel does not set the scale.
TEST(FieldScale, OfNothingAndOfOneSpark) {
  const FieldImage nothing(8, 8);
  EXPECT_EQ(Brightness(FieldScale({&nothing}).ValueColor(std::nanf(""))), Brightness(style::kGrid));
  EXPECT_NE(Brightness(FieldScale({}).ValueColor(1)), Brightness(FieldScale({}).ValueColor(0)));
  FieldImage image = Random(1, 0.1F, 3);
  const FieldScale before({&image});
  image.measured[30] = image.fitted[30] = 1e12F;
  const FieldScale after({&image});
  EXPECT_NEAR(Brightness(after.ValueColor(1)), Brightness(before.ValueColor(1)), 30);
}

TEST(Picture, PlacesPixelsRowByRow) {
  FieldImage image(3, 2);
  for (std::size_t i = 0; i < 6; ++i) image.measured[i] = static_cast<float>(i);
  const cv::Mat picture = Picture(image.measured, 3, 2, [](float v) {
    const auto level = static_cast<std::uint8_t>(10 * v);
    return Rgb{level, 1, 2};
  });
  ASSERT_TRUE(picture.cols == 3 && picture.rows == 2);
  EXPECT_EQ(picture.at<cv::Vec4b>(1, 0), cv::Vec4b(30, 1, 2, 255));
  EXPECT_EQ(picture.at<cv::Vec4b>(0, 2), cv::Vec4b(20, 1, 2, 255));
}

// The disc of n pixels covers pi / 4 of them, fades at its rim and nowhere else.
TEST(RoundPicture, IsADisc) {
  const cv::Mat picture(10, 10, CV_8UC4, cv::Scalar(9, 8, 7, 255));
  for (const int pixels : {1, 2, 33, 128}) {
    const cv::Mat disc = RoundPicture(picture, pixels);
    ASSERT_TRUE(disc.cols == pixels && disc.rows == pixels);
    double covered = 0;
    for (int y = 0; y < pixels; ++y) {
      for (int x = 0; x < pixels; ++x) {
        const cv::Vec4b p = disc.at<cv::Vec4b>(y, x);
        covered += p[3] / 255.0;
        EXPECT_EQ(p[0], 9);
        const double r = std::hypot(x + 0.5 - pixels / 2.0, y + 0.5 - pixels / 2.0) - pixels / 2.0;
        if (r < -1) {
          EXPECT_EQ(p[3], 255);
        }
        if (r > 1) {
          EXPECT_EQ(p[3], 0);
        }
      }
    }
    if (pixels > 30) {
      EXPECT_NEAR(covered, kPi / 4 * pixels * pixels, 0.01 * pixels * pixels);
    }
  }
}

}  // namespace
}  // namespace lobefit
