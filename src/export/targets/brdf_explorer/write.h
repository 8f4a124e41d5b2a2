// Disney's BRDF Explorer.
#pragma once

#include <string>
#include <vector>

#include "lobefit/export/targets/target.h"

namespace lobefit {

Target BrdfExplorerTarget();

// The parameters as sliders, tilt and rotation included.
std::string BrdfExplorerText(const FittedBrdf& fit, const std::vector<std::string>& header);

}  // namespace lobefit
