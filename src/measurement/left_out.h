// Where samples were that a user's word leaves out, for the picture of coverage.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lobefit/math/vec.h"

namespace lobefit {

enum class LeftOutReason : std::uint8_t {
  kNearMirror,  // --exclude specular
  kNearLight,   // --exclude retro
  kByValue,     // --exclude value
  kByAngle,     // --exclude theta-i, theta-o
  kNoValue,     // --no-value, or a word in place of a number
};
inline constexpr std::array<const char*, 5> kLeftOutWords = {
    "near the mirror direction", "near the light's own direction", "by their value", "by an angle", "without a value"};

// Unit directions away from the surface.
struct LeftOut {
  Vec3 wi, wo;
  LeftOutReason reason = LeftOutReason::kNoValue;
};
// More are counted by SetAside only.
inline constexpr std::size_t kMostLeftOut = 200000;

}  // namespace lobefit
