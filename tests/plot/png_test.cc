// PNG files that are packed in bands, read back by libpng.
#include "lobefit/plot/png.h"

#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <png.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

// Flat areas, edges, a gradient and noise.
cv::Mat MakePicture(int width, int height) {
  std::mt19937 random(7);
  cv::Mat picture(height, width, CV_8UC3, cv::Scalar::all(255));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      cv::Vec3b& p = picture.at<cv::Vec3b>(y, x);
      if (x > width / 2) p = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 17};
      if (y % 37 == 0 || x == 11) p = {0, 0, 0};
      if (x > 3 * width / 4 && y > height / 2) p[y % 3] = static_cast<std::uint8_t>(random());
    }
  }
  return picture;
}

cv::Mat Decode(const std::string& png) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, png.data(), png.size()), 0) << image.message;
  EXPECT_EQ(image.format & PNG_FORMAT_FLAG_COLOR, PNG_FORMAT_FLAG_COLOR);
  image.format = PNG_FORMAT_RGB;
  cv::Mat pixels(static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC3);
  EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.data, static_cast<png_int_32>(pixels.step), nullptr), 0)
      << image.message;
  EXPECT_EQ(image.warning_or_error, 0U) << image.message;
  return pixels;
}

bool AreEqual(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size()) return false;
  for (int y = 0; y < a.rows; ++y) {
    if (std::memcmp(a.ptr(y), b.ptr(y), static_cast<std::size_t>(a.cols) * 3) != 0) return false;
  }
  return true;
}

// One row, one column, less than a band, exactly one band (1024 rows of 1023 bytes and one more), many bands.
TEST(Png, IsReadBackAsItWas) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {5000, 1}, {1, 5000}, {300, 200}, {341, 1025}, {341, 1026}, {1700, 1500}}) {
    const cv::Mat picture = MakePicture(width, height);
    EXPECT_TRUE(AreEqual(Decode(EncodePng(picture, 96)), picture)) << width << " x " << height;
  }
}

TEST(Png, RowsOfALargerPictureAreNotTakenForOne) {
  const cv::Mat whole = MakePicture(400, 300), part = whole(cv::Rect(30, 40, 200, 100));
  ASSERT_FALSE(part.isContinuous());
  EXPECT_TRUE(AreEqual(Decode(EncodePng(part, 0)), part));
}

TEST(Png, HasTheSameBytesWithAnyNumberOfThreads) {
  const cv::Mat picture = MakePicture(1700, 1500);
  const std::string one = EncodePng(picture, 192, 1);
  EXPECT_EQ(one, EncodePng(picture, 192, 2));
  EXPECT_EQ(one, EncodePng(picture, 192, 7));
}

// What libpng's own chunks are asked for: resolution for printing only where it is given.
TEST(Png, StatesItsResolution) {
  const cv::Mat picture = MakePicture(20, 20);
  const std::string with = EncodePng(picture, 254), without = EncodePng(picture, 0);
  const std::size_t at = with.find("pHYs");
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(without.find("pHYs"), std::string::npos);
  // 254 pixels an inch are 10 000 a metre, in both directions.
  EXPECT_EQ(with.substr(at + 4, 9), std::string("\x00\x00\x27\x10\x00\x00\x27\x10\x01", 9));
}

TEST(Png, RefusesOtherPictures) {
  EXPECT_THROW(EncodePng(cv::Mat(), 96), OutputError);
  EXPECT_THROW(EncodePng(cv::Mat(4, 4, CV_8U, cv::Scalar(3)), 96), OutputError);
  EXPECT_THROW(EncodePng(cv::Mat(4, 4, CV_8UC4, cv::Scalar(3)), 96), OutputError);
}

}  // namespace
}  // namespace lobefit
