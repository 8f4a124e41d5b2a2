// Pictures of a validation: PNG files, drawn with the canvas of the reports. Each throws OutputError.
#pragma once

#include <filesystem>

#include "lobefit/validate/recovery.h"
#include "lobefit/validate/sweep.h"

namespace lobefit {

// Coverage of every parameter with its interval, and the histograms of errors in standard errors, of all parameters and
// of each, beside the normal density.
void DrawCalibration(const Experiment& experiment, const std::vector<Trial>& trials, const Calibration& calibration,
                     const std::filesystem::path& path);

// For fits of data without noise: the histogram of relative differences, and for each parameter the recovered against
// the true values.
void DrawRecovery(const Experiment& experiment, const std::vector<Trial>& trials, const Recovery& recovery,
                  const std::filesystem::path& path);

// For each parameter its error against the swept value: bias with the spread of the fits as whisker, beside what the
// standard errors claim; then coverage and misfit flags. Points many times farther out than the others are drawn at the
// frame's edge with their number.
void DrawSweep(const Sweep& sweep, const std::filesystem::path& path);

}  // namespace lobefit
