// One picture of an export: what it holds a texel, and how that is stored.
#pragma once

#include <array>
#include <functional>
#include <string>

#include "lobefit/maps/textures/numbers.h"

namespace lobefit {

// R, G, B, A as a renderer has them after reading: linear.
using TextureValue = std::array<double, 4>;

struct Texture {
  std::string ending;  // of the file's name, behind that of the material: "_normal.png". The same ending of two targets
                       // is the same picture.
  int channels = 3;    // 1, 3, 4
  int bits = 16;       // 8 or 16: PNG; 32: OpenEXR
  bool srgb = false;   // R, G, B are stored by sRGB's curve, A never
  std::function<TextureValue(const TexelNumbers&)> value;  // in [0, 1] for PNG: what is beyond is cut
};

// The value that comes back when the texel is written and read.
TextureValue Stored(const Texture& texture, const TexelNumbers& numbers);

// The whole file.
std::string EncodeTexture(const Texture& texture, const MapNumbers& numbers);

// The shading normal: (n + 1) / 2 in 16 bits, y up or down.
Texture NormalTexture(bool y_down);
Vec3 NormalOf(const TextureValue& value);

// cos and sin of the rotation as (v + 1) / 2 in R and G; `blue` beside them.
TextureValue DirectionValue(double rotation, double blue);
double RotationOf(const TextureValue& value);

// One number a texel.
Texture GreyTexture(const std::string& ending, double (*number)(const TexelNumbers&));
// A colour, linear in 16 bits.
Texture ColorTexture(const std::string& ending, Color3 (*color)(const TexelNumbers&));
inline Spectrum ColorOf(const TextureValue& value) { return {value[0], value[1], value[2]}; }

}  // namespace lobefit
