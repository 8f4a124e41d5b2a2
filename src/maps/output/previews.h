// Pictures of single maps for programs that read PNG: 16-bit normals, and what else people look at.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/maps/output/exr.h"

namespace lobefit {

// +y up (OpenGL, Blender, glTF) or down (DirectX).
enum class NormalY { kUp, kDown };

// NAME.normal.png (16 bits, (n + 1) / 2; +z where not determined), NAME.diffuse.png, NAME.f0.png (8 bits, sRGB, white
// at the 99th percentile where the stack is not calibrated), NAME.alpha.png (8 bits, linear, 0 where not determined)
// and NAME.normal_error.png (8 bits, white: 10 degrees and more). `maps`: the EXR, of which the planes of one picture
// are in memory at a time. Returns what was written.
std::vector<std::filesystem::path> WritePreviews(const std::filesystem::path& maps, bool calibrated, NormalY normal_y,
                                                 const std::filesystem::path& stem);

}  // namespace lobefit
