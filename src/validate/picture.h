// Pictures of a validation: PNG files, drawn with the canvas of the reports.
#pragma once

#include <filesystem>

#include "lobefit/validate/sweep.h"

namespace lobefit {

// Coverage of every parameter with its interval, the histogram of all errors in standard errors beside the normal
// density, and for each parameter the recovered against the true values (where materials are drawn) or the histogram of
// its errors. Throws OutputError.
void DrawCalibration(const Experiment& experiment, const std::vector<Trial>& trials, const Calibration& calibration,
                     const std::filesystem::path& path);

// For each parameter its error against the swept value: bias with the spread of the fits as whisker, beside what the
// standard errors claim; then coverage and misfit flags.
void DrawSweep(const Sweep& sweep, const std::filesystem::path& path);

}  // namespace lobefit
