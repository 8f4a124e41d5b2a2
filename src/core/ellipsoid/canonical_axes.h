// The canonical form of an ellipsoid from its principal axes: which axis is called x, y and z, and with which signs.
#pragma once

#include <array>

#include "lobefit/core/ellipsoid/ellipsoid.h"
#include "lobefit/core/ellipsoid/principal_axes.h"

namespace lobefit {

// length[y] <= length[x] <= length[z], right-handed, z on the upper side, R11 > 0 (theta_z in (-pi/2, pi/2]).
// turn * B = diag(length) * axis for the B whose principal axes these are.
struct CanonicalAxes {
  std::array<double, 3> length;
  std::array<Vec3, 3> axis, turn;
  bool degenerate;  // two lengths agree to 32 eps
};

// Where lengths coincide the axes are a free choice; the one with the angles that are not determined at 0 is made:
// theta_z = 0 if x and y are equal, theta_y = 0 if x and z are, all angles 0 if all are; `turn` then belongs to the
// axes before that choice.
CanonicalAxes ToCanonicalAxes(const PrincipalAxes& axes);

// alpha_x = length[x] / length[z] ..., angles of the rotation whose rows are the axes.
Ellipsoid EllipsoidFromAxes(const CanonicalAxes& axes);

// theta_x, theta_y, theta_z of R = Rx Ry Rz, theta_y in [-pi/2, pi/2]; the alphas are put in as they are. R orthogonal,
// det 1.
Ellipsoid EllipsoidFromRotation(double alpha_x, double alpha_y, const Mat3& rotation);

}  // namespace lobefit
