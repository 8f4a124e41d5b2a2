// Mitsuba 3: `roughconductor` with GGX, blended with `diffuse`.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lobefit/export/targets/target.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {

// The fit as Mitsuba evaluates it: exact Fresnel of the nearest index, separable masking, one tangent for all lobes.
Surface MitsubaSurface(const FittedBrdf& fit);
// NAME.xml is a scene file with the BSDF, to be included; NAME.py holds the same as a Python dict.
WrittenFiles WriteMitsuba(const FittedBrdf& fit, const WriteContext& context);

// The last bsdf of the file: roughconductor (GGX; rgb or float eta and k), diffuse, blendbsdf, normalmap and twosided
// are understood. Throws InputError.
Surface ReadMitsuba(std::string_view bytes, const std::filesystem::path& path);

}  // namespace lobefit
