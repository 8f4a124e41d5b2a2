// Rotation vectors: R = exp([r]), [r] w = r x w (Rodrigues' formula), and the left Jacobian that carries derivatives to
// r.
#pragma once

#include "lobefit/math/vec.h"

namespace lobefit {

// Rotation by |r| radians about r, counter-clockwise seen from the tip of r; any r, accurate for tiny |r| too.
Mat3 RotationMatrix(const Vec3& r);

// J with exp([r + d]) = exp([J d]) exp([r]) to first order in d. With v = exp([r]) w, dv = (J dr) x v, hence for a
// scalar f(v) df/dr = J^T (v x df/dv).
Mat3 RotationLeftJacobian(const Vec3& r);

}  // namespace lobefit
