// What a fit determined: tilts and turns that its data do not tell apart from none are left out of an export.
#pragma once

#include <vector>

#include "lobefit/export/targets/target.h"
#include "lobefit/material/material.h"

namespace lobefit {

struct Determined {
  Material material;
  std::vector<Carried> left_out;  // the tilt and turn rows of what was taken out, with angle and error
};

// A lobe's tilt (theta_x, theta_y) is left out where it lies within the ellipse of two standard errors about none; its
// turn theta_z where it is below two standard errors; a lobe whose turn was fitted with an error of 22.5 degrees or
// more, or none at all, becomes round with the geometric mean of its widths. Errors are those clustered by incidence
// where the document has them. A parameter that was given, not fitted, stays.
Determined OnlyDetermined(const Material& material);

}  // namespace lobefit
