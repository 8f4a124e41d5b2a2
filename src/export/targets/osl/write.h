// OSL: the function and a shader that evaluates it.
#pragma once

#include <string>
#include <vector>

#include "lobefit/export/targets/target.h"

namespace lobefit {

Target OslTarget();

// `vector lobefit_f_r(vector wi, vector wo)` and a shader of the name with wi and wo as inputs and f_r as output: a
// function of two directions, no closure.
std::string OslText(const FittedBrdf& fit, const std::string& name, const std::vector<std::string>& header);

}  // namespace lobefit
