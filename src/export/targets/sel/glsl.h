// A table of squared ellipsoidal lobes as GLSL.
#pragma once

#include <string>
#include <vector>

#include "lobefit/core/sel/sel_table.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// GLSL (ES 3.00 and 3.30 upwards) without a version line, in the frame of tangent, bitangent and normal:
// with NAME the identifier of `name`, which the first file of a shader may leave out (lobefit_f_r):
//   vec3 lobefit_NAME_f_r(vec3 wi, vec3 wo): the table as SelReflectance interpolates and evaluates it;
//   vec3 lobefit_NAME_f_r_bound(vec3 wi, vec3 axis, float half_angle), of tables of f_r cos_theta_o
//   lobefit_NAME_f_r_cos_bound:
//     not below the table's quantity at any wo within half_angle radians of the unit vector `axis`.
// For R G B or one channel; for other channels both return nothing and fill `out float x[N]` as their last argument.
std::string SelGlslText(const SelReflectance& reflectance, const Channels& channels, const std::string& name,
                        const std::vector<std::string>& header);

}  // namespace lobefit
