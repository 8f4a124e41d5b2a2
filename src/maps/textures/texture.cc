#include "lobefit/maps/textures/texture.h"

#include <algorithm>
#include <cmath>

#include "lobefit/maps/output/pixels.h"
#include "lobefit/maps/stack/response.h"

namespace lobefit {
namespace {

bool ByCurve(const Texture& texture, std::size_t channel) { return texture.srgb && channel < 3; }

std::uint16_t CodeOf(const Texture& texture, std::size_t channel, double value) {
  static const Response kSrgb = {Response::Curve::kSrgb};
  const double v = std::clamp(value, 0.0, 1.0), stored = ByCurve(texture, channel) ? Stored(kSrgb, v) : v;
  return static_cast<std::uint16_t>(std::lround(stored * ((1 << texture.bits) - 1)));
}

double ValueOf(const Texture& texture, std::size_t channel, std::uint16_t code) {
  static const Response kSrgb = {Response::Curve::kSrgb};
  const double stored = static_cast<double>(code) / ((1 << texture.bits) - 1);
  return ByCurve(texture, channel) ? Linear(kSrgb, stored) : stored;
}

}  // namespace

TextureValue Stored(const Texture& texture, const TexelNumbers& numbers) {
  TextureValue value = texture.value(numbers);
  for (std::size_t c = 0; c < static_cast<std::size_t>(texture.channels); ++c) {
    value[c] = texture.bits == 32 ? static_cast<double>(static_cast<float>(value[c]))
                                  : ValueOf(texture, c, CodeOf(texture, c, value[c]));
  }
  return value;
}

std::string EncodeTexture(const Texture& texture, const MapNumbers& numbers) {
  const std::size_t texels = numbers.width() * numbers.height(), channels = static_cast<std::size_t>(texture.channels);
  std::vector<float> floats;
  std::vector<std::uint16_t> codes;
  for (std::size_t t = 0; t < texels; ++t) {
    const TextureValue value = texture.value(numbers.At(t));
    for (std::size_t c = 0; c < channels; ++c) {
      if (texture.bits == 32) {
        floats.push_back(static_cast<float>(value[c]));
      } else {
        codes.push_back(CodeOf(texture, c, value[c]));
      }
    }
  }
  if (texture.bits == 32) return EncodeExr(std::move(floats), numbers.width(), numbers.height(), channels);
  return EncodePixels(codes, numbers.width(), numbers.height(), texture.channels, texture.bits);
}

Texture NormalTexture(bool y_down) {
  return {y_down ? "_normal_down.png" : "_normal.png", 3, 16, false, [y_down](const TexelNumbers& numbers) {
            const Vec3& n = numbers.normal;
            return TextureValue{(n.x + 1) / 2, ((y_down ? -n.y : n.y) + 1) / 2, (n.z + 1) / 2, 1};
          }};
}

Vec3 NormalOf(const TextureValue& value) {
  return Normalized(Vec3{2 * value[0] - 1, 2 * value[1] - 1, 2 * value[2] - 1});
}

TextureValue DirectionValue(double rotation, double blue) {
  return {(std::cos(rotation) + 1) / 2, (std::sin(rotation) + 1) / 2, blue, 1};
}

double RotationOf(const TextureValue& value) { return std::atan2(2 * value[1] - 1, 2 * value[0] - 1); }

Texture GreyTexture(const std::string& ending, double (*number)(const TexelNumbers&)) {
  return {ending, 1, 16, false, [number](const TexelNumbers& numbers) { return TextureValue{number(numbers)}; }};
}

Texture ColorTexture(const std::string& ending, Color3 (*color)(const TexelNumbers&)) {
  return {ending, 3, 16, false, [color](const TexelNumbers& numbers) {
            const Color3 c = color(numbers);
            return TextureValue{c[0], c[1], c[2], 1};
          }};
}

}  // namespace lobefit
