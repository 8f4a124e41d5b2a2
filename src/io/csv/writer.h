// Writing a measurement as goniometer CSV that ReadCsv reads back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// theta_i,phi_i,theta_o,phi_o in degrees, then one column of f_r a channel, with as many digits as give the same double
// back; the header lines state unit, value kind and direction sense. `comments` become comment lines at the top
// (without their "# ").
void WriteCsv(const Measurement& measurement, const std::vector<std::string>& comments,
              const std::filesystem::path& path, int digits = 17);

// Whether the reader would find the channels again by their names. Throws InputError with the cure where it would not.
void RequireReadableChannels(const Channels& channels);

}  // namespace lobefit
