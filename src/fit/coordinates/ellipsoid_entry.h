// The parameters of an ellipsoid by their number in Parameters(model): widths first, then angles.
#pragma once

#include "lobefit/core/ellipsoid/ellipsoid.h"

namespace lobefit {

inline double* EllipsoidEntry(Ellipsoid* ellipsoid, int i) {
  double* entries[] = {&ellipsoid->alpha_x, &ellipsoid->alpha_y, &ellipsoid->theta_x, &ellipsoid->theta_y,
                       &ellipsoid->theta_z};
  return entries[i];
}

}  // namespace lobefit
