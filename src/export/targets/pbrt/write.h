// pbrt-v4: `conductor` with its reflectance, mixed with `diffuse`.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/export/targets/target.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {

// The fit as pbrt evaluates it: exact Fresnel of eta = 1 and the k of each reflectance, height-correlated masking, one
// tangent for all lobes.
Surface PbrtSurface(const FittedBrdf& fit);
WrittenFiles WritePbrt(const FittedBrdf& fit, const WriteContext& context);

// The last material of the text. Named materials of the types conductor (by reflectance, or rgb eta and k), diffuse
// and mix are understood. Throws InputError with file and line.
Surface ReadPbrt(std::string_view text, const std::filesystem::path& path);

}  // namespace lobefit
