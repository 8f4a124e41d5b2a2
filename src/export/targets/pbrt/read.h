// Reading materials of pbrt-v4.
#pragma once

#include <string_view>

#include "lobefit/export/targets/target.h"

namespace lobefit {

// Below this width in both axes pbrt-v4 makes a lobe a perfect mirror.
inline constexpr double kPbrtMirror = 1e-3;

bool IsPbrt(std::string_view bytes);
// The last material of the text. Materials of the types conductor (by reflectance, or eta and k), diffuse and mix are
// understood, as rgb or as spectra that share their wavelengths. Throws InputError with file and line.
ImportedMaterial ReadPbrt(const InputFile& file);

}  // namespace lobefit
