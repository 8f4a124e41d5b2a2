// A picture of normals that a fit takes as they are.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "lobefit/maps/stack/image_rows.h"
#include "lobefit/maps/stack/stack.h"

namespace lobefit {

// Red, green and blue are x, y and z: of a picture of 16 bits (value + 1) / 2, of one in floating point the value.
// `down`: y runs down the picture. Throws InputError where it is no such picture or of another size than the images.
void SetNormalMap(const std::filesystem::path& file, bool down, Stack* stack);

// Its rows. Throws InputError.
std::unique_ptr<ImageRows> OpenNormalMap(const Stack& stack);

// Appends the next row, unit vectors in the frame of the stack; NaN where the picture has none that faces the camera.
void ReadNormals(ImageRows* rows, bool down, std::vector<Vec3>* normals);

}  // namespace lobefit
