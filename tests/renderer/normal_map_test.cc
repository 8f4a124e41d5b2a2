// Constant normal maps: written and read back, and files that are none.
#include "lobefit/renderer/normal_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "lobefit/base/error.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

double DegreesBetween(const Vec3& a, const Vec3& b) { return RadiansToDegrees(std::asin(Norm(Cross(a, b)))); }

std::string PngOf(const std::vector<std::uint8_t>& rgb, unsigned width, unsigned height) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  std::string png(10000 + 3 * rgb.size(), '\0');
  png_alloc_size_t bytes = png.size();
  EXPECT_NE(png_image_write_to_memory(&image, png.data(), &bytes, 0, rgb.data(), 0, nullptr), 0);
  png.resize(bytes);
  return png;
}

std::string Refusal(std::string_view png) {
  try {
    NormalOfPng(png, 1, "bent.png");
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(NormalMap, SixteenBitsKeepTheNormalToThousandthsOfADegree) {
  for (const double theta : {0.0, 0.01, 1.0, 15.0, 60.0}) {
    for (const double phi : {0.0, 33.0, 200.0}) {
      const Vec3 normal = FromSpherical(DegreesToRadians(theta), DegreesToRadians(phi));
      EXPECT_LT(DegreesBetween(NormalOfPng(NormalMapPng(normal), 1, "n.png"), normal), 0.002) << theta << ' ' << phi;
    }
  }
}

TEST(NormalMap, EightBitsAndAScaleKeepItToAHundredth) {
  // Along an axis the other component is half a step, 1/255 of the longest: of tilts above two degrees that is more.
  constexpr double kStep = 1.0 / 255;
  for (const double theta : {0.05, 1.0, 2.0, 15.0, 60.0}) {
    for (const double phi : {0.0, 33.0, 200.0, 271.0}) {
      const Vec3 normal = FromSpherical(DegreesToRadians(theta), DegreesToRadians(phi));
      const ScaledNormal map = ScaledNormalMapPng(normal);
      EXPECT_LT(DegreesBetween(NormalOfPng(map.png, map.scale, "n.png"), normal),
                std::max(0.01, RadiansToDegrees(1.1 * kStep * std::sin(DegreesToRadians(theta)))))
          << theta << ' ' << phi;
    }
  }
}

TEST(NormalMap, AnEncoderMayLeaveOneStep) {
  const std::string png = PngOf({128, 128, 255, 129, 128, 254}, 2, 1);
  EXPECT_LT(DegreesBetween(NormalOfPng(png, 1, "n.png"), {0, 0, 1}), 0.5);
}

TEST(NormalMap, RefusesWhatIsNotOneNormal) {
  EXPECT_THAT(Refusal(PngOf({128, 128, 255, 128, 150, 250}, 2, 1)),
              testing::HasSubstr("bent.png: the normal map varies (pixel 1"));
  EXPECT_THAT(Refusal(PngOf({128, 128, 20}, 1, 1)), testing::HasSubstr("points into the surface"));
  EXPECT_THAT(Refusal(""), testing::HasSubstr("not a PNG that can be read"));
  EXPECT_THAT(Refusal("P6 1 1 255 abc"), testing::HasSubstr("not a PNG that can be read"));
}

// Each cut of a file, and each byte of its head turned: a normal or an error with the file's name, no crash.
TEST(NormalMap, DamagedFilesEndInAnErrorOrANormal) {
  const std::string png = NormalMapPng(FromSpherical(0.2, 1));
  for (std::size_t length = 0; length + 12 < png.size(); length += 3)
    EXPECT_THAT(Refusal(png.substr(0, length)), testing::HasSubstr("bent.png: ")) << length;
  for (std::size_t at = 0; at < 33; ++at) {
    std::string damaged = png;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x41);
    EXPECT_THAT(Refusal(damaged), testing::HasSubstr("bent.png: ")) << at;
  }
}

TEST(NormalMap, ALargePictureIsRefusedBeforeItIsUnpacked) {
  const std::vector<std::uint8_t> row(3 * 4097, 128);
  EXPECT_THAT(Refusal(PngOf(row, 4097, 1)), testing::HasSubstr("more than 4096 pixels a side"));
}

}  // namespace
}  // namespace lobefit
