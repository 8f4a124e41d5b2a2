#include "lobefit/renderer/normal_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <png.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

constexpr unsigned kEdge = 4;
// Pixels of a constant map may differ by one step of 8 bits, as an encoder may leave them.
constexpr double kConstant = 1.01 * 2 / 255;

template <class Value>
std::string Encode(const std::array<Value, 3>& pixel, png_uint_32 format) {
  std::vector<Value> pixels;
  for (unsigned i = 0; i < kEdge * kEdge; ++i) pixels.insert(pixels.end(), pixel.begin(), pixel.end());
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = image.height = kEdge;
  image.format = format;
  png_alloc_size_t bytes = 0;
  std::string png;
  if (png_image_write_to_memory(&image, nullptr, &bytes, 0, pixels.data(), 0, nullptr) != 0) {
    png.resize(bytes);
    if (png_image_write_to_memory(&image, png.data(), &bytes, 0, pixels.data(), 0, nullptr) != 0) {
      png.resize(bytes);
      return png;
    }
  }
  throw OutputError(std::string("normal map: ") + image.message);
}

}  // namespace

std::string NormalMapPng(const Vec3& normal) {
  const auto stored = [](double v) { return static_cast<std::uint16_t>(std::lround(65535 * (v + 1) / 2)); };
  return Encode<std::uint16_t>({stored(normal.x), stored(normal.y), stored(normal.z)}, PNG_FORMAT_LINEAR_RGB);
}

ScaledNormal ScaledNormalMapPng(const Vec3& normal) {
  // Blue 255 is z = 1 exactly; of all pairs of red and green, one whose direction is right, the longest.
  ScaledNormal result;
  const double length = std::hypot(normal.x, normal.y);
  std::array<int, 2> best = {255, 255};
  double least = 1e9;
  for (int red = 0; red < 256; ++red) {
    for (int green = 0; green < 256; ++green) {
      const double x = 2 * red / 255.0 - 1, y = 2 * green / 255.0 - 1, r = std::hypot(x, y);
      if (r < 0.5) continue;
      const double off = std::hypot(x / r - normal.x / length, y / r - normal.y / length);
      if (off < least) least = off, best = {red, green};
    }
  }
  const double r = std::hypot(2 * best[0] / 255.0 - 1, 2 * best[1] / 255.0 - 1);
  result.scale = length / normal.z / r;
  result.png = Encode<std::uint8_t>({static_cast<std::uint8_t>(best[0]), static_cast<std::uint8_t>(best[1]), 255},
                                    PNG_FORMAT_RGB);
  return result;
}

Vec3 NormalOfPng(std::string_view png, double scale, const std::filesystem::path& file) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  Vec3 normal = {0, 0, 1};
  if (png_image_begin_read_from_memory(&image, png.data(), png.size()) != 0) {
    const bool deep = (image.format & PNG_FORMAT_FLAG_LINEAR) != 0;
    if (image.width > 4096 || image.height > 4096) {
      png_image_free(&image);
      throw InputError(file.string() + ": a normal map of more than 4096 pixels a side; a constant one is expected");
    }
    const std::size_t values = std::size_t{3} * image.width * image.height;
    image.format = deep ? PNG_FORMAT_LINEAR_RGB : PNG_FORMAT_RGB;
    std::vector<std::uint16_t> pixels(values);
    if (png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) != 0) {
      const auto* bytes = static_cast<const std::uint8_t*>(static_cast<const void*>(pixels.data()));
      const auto at = [&](std::size_t c) { return 2 * (deep ? pixels[c] / 65535.0 : bytes[c] / 255.0) - 1; };
      for (std::size_t value = 0; value < values; ++value) {
        if (std::fabs(at(value) - at(value % 3)) <= kConstant) continue;
        throw InputError(file.string() + ": the normal map varies (pixel " + std::to_string(value / 3) +
                         " is not as the first); only a constant one is understood");
      }
      normal = {scale * at(0), scale * at(1), at(2)};
      if (normal.z > 0) return Normalized(normal);
      throw InputError(file.string() + ": the normal map points into the surface");
    }
  }
  const std::string message = image.message;
  png_image_free(&image);
  throw InputError(file.string() + ": the normal map is not a PNG that can be read (" + message + ")");
}

}  // namespace lobefit
