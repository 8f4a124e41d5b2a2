// The targets that take program text, and so evaluate the fitted model itself.
#pragma once

#include <string>
#include <vector>

#include "lobefit/export/targets/target.h"
#include "lobefit/renderer/fitted_brdf.h"

namespace lobefit {

// GLSL (ES 3.00 and 3.30 upwards) without a version line: `vec3 lobefit_f_r(vec3 wi, vec3 wo)` for R G B or one
// channel, else `void lobefit_f_r(vec3 wi, vec3 wo, out float f_r[N])`; directions in the frame of tangent, bitangent
// and normal.
std::string GlslText(const FittedBrdf& fit, const std::vector<std::string>& header);
// OSL: the same function and a shader of the name with wi and wo as inputs and f_r as output.
std::string OslText(const FittedBrdf& fit, const std::string& name, const std::vector<std::string>& header);
// Disney BRDF Explorer: the parameters as sliders, tilt and rotation included.
std::string BrdfExplorerText(const FittedBrdf& fit, const std::vector<std::string>& header);

WrittenFiles WriteGlsl(const FittedBrdf& fit, const WriteContext& context);
WrittenFiles WriteOsl(const FittedBrdf& fit, const WriteContext& context);
WrittenFiles WriteBrdfExplorer(const FittedBrdf& fit, const WriteContext& context);

}  // namespace lobefit
