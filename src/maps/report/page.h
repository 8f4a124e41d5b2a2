// The picture of a fit a texel: maps beside their errors, what is doubtful, a photograph beside the fit.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/maps/report/relit_error.h"

namespace lobefit {

struct MapsPage {
  std::string title, subtitle;
  std::vector<RelitLight> lights;
  Fallback fallback;
};

// Drawn and written as PNG. Shown are the worst light that was left out of the fit, or the first one asked for, and the
// worst of all. Throws OutputError.
void WriteMapsReport(const Maps& maps, const Stack& stack, const MapsPage& page, double scale,
                     const std::filesystem::path& path);

}  // namespace lobefit
