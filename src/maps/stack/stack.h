// An image stack: photographs of one surface from one place, each under one light, registered to the pixel.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/maps/stack/response.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// Unit direction from the surface (of near lights: from the middle of the picture) to a light, and what the pixels of
// each channel are divided by.
struct StackLight {
  Vec3 direction;
  std::array<double, 3> intensity = {1, 1, 1};
  Vec3 place = {0, 0, 0};  // as the file gives it: of near lights the position, mm
};

// Lights at positions, mm from the middle of the picture in its plane z = 0.
struct NearLights {
  bool inverse_square = true;  // intensities are those at `reference_mm` from a light; else at every texel
  double reference_mm = 0;     // mean distance of the lights from the middle
  double exponent = 0;  // of the cosine to a light's axis, which points to the middle: 0 for a bulb, 1 for a flat LED
};

// Everything but the pixels. x runs right and y up over the picture, z to the camera. After division by the intensity
// (and, of near lights, by what distance and axis make of it) a pixel is f_r cos_theta_i, in 1/sr where `calibrated`,
// else times one unknown factor of the whole stack.
struct Stack {
  std::filesystem::path path;  // as given
  std::string layout;          // "DiLiGenT folder", ...
  std::vector<std::filesystem::path> images;
  std::vector<std::string> parts;  // where all images are parts of one OpenEXR file: their names; else empty
  std::vector<StackLight> lights;  // one an image
  std::optional<NearLights> near;  // else they are distant
  double width_mm = 0;             // of the picture; 0: not said, and then nothing has a position
  // Positions, mm, of one camera or one a photograph, whose pictures show the plane z = 0 without perspective; empty:
  // orthographic, wo = +z.
  std::vector<Vec3> cameras;
  std::size_t width = 0, height = 0, channels = 0;
  std::filesystem::path normal_map;  // of normals that are held: README.md of maps; empty: none
  bool normal_map_down = false;      // its y runs down
  std::vector<std::uint8_t> mask;    // [row width + column], 0: no texel; empty: all are
  Response response;
  std::filesystem::path dark;                // photograph without a light, subtracted; empty: none
  std::vector<std::filesystem::path> white;  // of a white matt board under each light, divided by; empty: none
  double white_albedo = 1;
  bool calibrated = false;
  std::vector<std::string> remarks;

  // Whether wi or wo differ from texel to texel.
  bool MovesPaths() const { return near.has_value() || !cameras.empty(); }
  bool Holds(std::size_t texel) const { return mask.empty() || mask[texel] != 0; }
  std::size_t Texels() const;
};

// What is said on the command line about a stack that does not say it itself; empty: nothing.
struct StackOptions {
  std::string encoding;
};

// Reads the layout by content: a folder of DiLiGenT's, an RTI light file (.lp), a dome or MaterialGAN's JSON beside its
// images, a stack.toml or a folder with one. Opens each image to see its size. Throws InputError that names the file
// and the cure.
Stack OpenStack(const std::filesystem::path& path, const StackOptions& options);

// Whether OpenStack would take the path for a stack: by its name and what lies in the folder, not by its images.
bool LooksLikeStack(const std::filesystem::path& path);

// SHA-256 of everything that a fit depends on: the bytes of the images, and lights, mask and response as read.
std::string DigestOf(const Stack& stack);

}  // namespace lobefit
