// The layouts that OpenStack knows: each fills images, lights and what else its files say; sizes, mask and response are
// checked by OpenStack.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/maps/stack/stack.h"

namespace lobefit {

// What a layout says; `mask`: a file, or empty.
struct StackFiles {
  Stack stack;
  std::filesystem::path mask;
};

// filenames.txt, light_directions.txt, light_intensities.txt and mask.png in one folder, 16-bit linear images [Shi et
// al. 2016, DiLiGenT]. Directions may also stand as three rows of numbers.
StackFiles ReadDiligent(const std::filesystem::path& folder);

// "N", then N lines "FILE x y z"; names may hold blanks, and are looked for beside the light file.
StackFiles ReadLightFile(const std::filesystem::path& file);

// A dome of RelightLab (.dome, JSON): directions, or positions in the unit of imageWidth; the images beside it by name.
StackFiles ReadDome(const std::filesystem::path& file);

// The JSON of MaterialGAN's captures: im_size (cm, side of the square picture), camera_pos, light_pos, light_pow, and
// the images NN.png of `idx` in target_dir, with gamma 2.2 [as the reader of tflsguoyu's svbrdf-diff-renderer has it].
StackFiles ReadMaterialGan(const std::filesystem::path& file);
bool IsMaterialGan(const std::filesystem::path& file);

// Images named by angles, "tl045 pl090 tv000 pv000.png" with anything between [as UBO2003 and UTIA have it]: polar
// angle and azimuth of light and viewer, degrees. Views other than from above are left out, and counted.
StackFiles ReadAngleNames(const std::filesystem::path& folder);
bool HasAngleNames(const std::filesystem::path& folder);

// stack.toml, README.md of this folder.
StackFiles ReadManifest(const std::filesystem::path& file);

// Rows of numbers, one a line, blank lines and lines that begin with # skipped; all with `columns` numbers, or, where
// `columns` rows of another length are found, transposed. Throws InputError with the line.
std::vector<std::vector<double>> ReadTable(const std::filesystem::path& file, std::size_t columns);

// Takes the places of the lights for positions over a picture of this width. Throws InputError, with `name` in front,
// where one is not in front of the picture. reference_mm of `near` is filled.
void SetNear(NearLights near, double width_mm, const std::string& name, Stack* stack);
// Likewise of cameras.
void SetCameras(const std::vector<Vec3>& cameras, double width_mm, const std::string& name, Stack* stack);

// By its extension, an image that OpenImage may read.
bool IsImageName(const std::filesystem::path& path);

// Unit vector of a direction in a file. Throws InputError where it is not finite or shorter than 1e-4.
Vec3 LightDirection(double x, double y, double z, const std::string& place);

}  // namespace lobefit
