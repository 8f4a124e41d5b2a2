// GLSL (ES 3.00 and 3.30 upwards) without a version line.
#pragma once

#include <string>
#include <vector>

#include "lobefit/export/targets/target.h"

namespace lobefit {

Target GlslTarget();

// `vec3 lobefit_NAME_f_r(vec3 wi, vec3 wo)` for R G B or one channel, else `void lobefit_NAME_f_r(vec3 wi, vec3 wo, out
// float f_r[N])`, with NAME the identifier of `name`; directions in the frame of tangent, bitangent and normal. What
// every file needs stands behind #ifndef, so that several files make one shader; the first of them is lobefit_f_r too.
std::string GlslText(const FittedBrdf& fit, const std::string& name, const std::vector<std::string>& header);

}  // namespace lobefit
