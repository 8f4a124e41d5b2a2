// Reading materials of Mitsuba.
#pragma once

#include <string_view>

#include "lobefit/export/targets/target.h"

namespace lobefit {

bool IsMitsuba(std::string_view bytes);
// The last bsdf of the file: roughconductor (GGX; eta and k as numbers, rgb or spectra that share their wavelengths),
// diffuse, blendbsdf, normalmap and twosided are understood. Names of scenes before version 2 are read as Mitsuba 3
// reads them ("alphaU" as "alpha_u"). Throws InputError for a property that is not understood.
ImportedMaterial ReadMitsuba(const InputFile& file);

}  // namespace lobefit
