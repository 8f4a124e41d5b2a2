// The result of a validation as a JSON document.
#pragma once

#include <string>

#include "lobefit/validate/calibration.h"

namespace lobefit {

// Indented by two blanks; NaN as null. `command` is the command line.
std::string ToJson(const Experiment& experiment, const Calibration& calibration, const std::string& command);

}  // namespace lobefit
