// Writing a measurement as ALTA text.
#pragma once

#include <filesystem>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Rows theta_i phi_i theta_o phi_o (SPHERICAL_TL_PL_TV_PV, radians) and f_r of each channel (INV_STERADIAN). The format
// has no names of channels: wavelengths stand in a comment, with those of the measurement. Standard deviations are
// columns of confidence (#VS), of which a comment says what they are (kAltaSigma); without them weights are, as
// half-widths of which the inverse squares are in the ratio of the weights.
void WriteAlta(const Measurement& measurement, const std::filesystem::path& path);

}  // namespace lobefit
