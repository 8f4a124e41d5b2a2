// What the inverse of an arrow makes of some rows.
#pragma once

#include <Eigen/Core>

#include "lobefit/fit/coordinates/arrow.h"

namespace lobefit {

// rows hessian^-1, k x coordinates. Of directions that the data do not determine nothing is left up to 200 coordinates;
// of more a hair of curvature, 1e-10 of that of the coordinates alone, holds them.
Eigen::MatrixXd TimesInverse(const Eigen::MatrixXd& rows, const ArrowMatrix& hessian);

}  // namespace lobefit
