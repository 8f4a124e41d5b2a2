// The result of a validation as a JSON document: calibration of intervals, or recovery without noise.
#pragma once

#include <string>

#include "lobefit/validate/calibration.h"
#include "lobefit/validate/recovery.h"

namespace lobefit {

// Indented by two blanks; NaN as null. `command` is the command line.
// `without`: of the same measurements fitted without the instrument; null: not done.
std::string ToJson(const Experiment& experiment, const Calibration& calibration, const Calibration* without,
                   const std::string& command);

std::string ToJson(const Experiment& experiment, const Recovery& recovery, const std::string& command);

// One point of a sweep on one line, with members "sweep" and "value".
std::string ToJsonLine(const std::string& sweep, const std::string& value, const Experiment& experiment,
                       const Calibration& calibration, const std::string& command);

}  // namespace lobefit
