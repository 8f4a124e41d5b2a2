// A stack as a light dome would have photographed maps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "lobefit/maps/output/exr.h"
#include "lobefit/maps/relight.h"
#include "lobefit/synthesis/synthesis.h"

namespace lobefit {

// `count` lights evenly over the cap of polar angles up to `theta_max` about z.
std::vector<Vec3> DomeLights(std::size_t count, double theta_max);

struct StackSynthesis {
  std::vector<Vec3> lights;
  // Widths of the picture, which is 100 mm wide, from its middle to bulbs in these directions; 0: distant lights.
  double distance = 0;
  double camera_distance = 0;  // likewise of a camera above the middle; 0: orthographic
  bool calibrated = true;
  Noise noise;  // multiplicative and additive alone
  std::uint64_t seed = 1;
  int bits = 16;  // 16: PNG, the brightest value at 0.9; 32: OpenEXR
  // Whether a texel is in the shadow of something; empty: never.
  std::function<bool(std::size_t texel, const Vec3& light)> shadow;
  Fallback fallback;
};

// Writes stack.toml, lights.lp, intensity.txt, the images 001.png, ... and truth.maps.exr into the folder, which is
// made. Throws UsageError for other noise, OutputError.
void WriteStack(const Maps& maps, const StackSynthesis& synthesis, const std::filesystem::path& folder);

}  // namespace lobefit
