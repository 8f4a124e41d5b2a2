// Writing measurements as pab-opto Mountain text: one incident direction a file.
#pragma once

#include <filesystem>
#include <vector>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// One file an incident direction. With one incidence the file is `path`, otherwise "NAME_thetaTT_phiPP.EXT" beside it.
// Rows theta phi BRDF in degrees; the value is Y of X Y Z or R G B (sRGB primaries), or the one channel. Returns the
// files. Throws UsageError for channels that have no Y and for an isotropic table, which has no list of incidences.
std::vector<std::filesystem::path> WriteMountain(const Measurement& measurement, const std::filesystem::path& path);

}  // namespace lobefit
