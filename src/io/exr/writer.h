// Writing BRDF images in OpenEXR: slices and hemispheres, with attributes that say what the pixels are.
#pragma once

#include <cstddef>
#include <filesystem>

#include "lobefit/io/exr/map.h"
#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// f_r at the pixels' centres as 32-bit floats, NaN where a pixel is no pair of directions. Channels R G B, Y, or named
// as wavelengths. `source` goes to the attribute brdf.source. Throws OutputError.
void WriteExr(const BrdfFunction& brdf, const Channels& channels, const ExrMap& map, std::size_t width,
              std::size_t height, const std::string& source, const std::filesystem::path& path, int threads = 0);

}  // namespace lobefit
