// An image stack: photographs of one surface from one place, each under one light, registered to the pixel.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/maps/stack/response.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// A distant light: unit direction from the surface to it, and what the pixels of each channel are divided by.
struct StackLight {
  Vec3 direction;
  std::array<double, 3> intensity = {1, 1, 1};
};

// Everything but the pixels. x runs right and y up over the picture, z to the camera, which is orthographic: wo = +z.
// After division by the intensity a pixel is f_r cos_theta_i, in 1/sr where `calibrated`, else times one unknown factor
// of the whole stack.
struct Stack {
  std::filesystem::path path;  // as given
  std::string layout;          // "DiLiGenT folder", ...
  std::vector<std::filesystem::path> images;
  std::vector<StackLight> lights;  // one an image
  std::size_t width = 0, height = 0, channels = 0;
  std::vector<std::uint8_t> mask;  // [row width + column], 0: no texel; empty: all are
  Response response;
  bool calibrated = false;
  std::vector<std::string> remarks;

  bool Holds(std::size_t texel) const { return mask.empty() || mask[texel] != 0; }
  std::size_t Texels() const;
};

// What is said on the command line about a stack that does not say it itself; empty: nothing.
struct StackOptions {
  std::string encoding;
};

// Reads the layout by content: a folder of DiLiGenT's, an RTI light file (.lp) beside its images, a stack.toml or a
// folder with one. Opens each image to see its size. Throws InputError that names the file and the cure.
Stack OpenStack(const std::filesystem::path& path, const StackOptions& options);

// Whether OpenStack would take the path for a stack: by its name and what lies in the folder, not by its images.
bool LooksLikeStack(const std::filesystem::path& path);

// SHA-256 of everything that a fit depends on: the bytes of the images, and lights, mask and response as read.
std::string DigestOf(const Stack& stack);

}  // namespace lobefit
