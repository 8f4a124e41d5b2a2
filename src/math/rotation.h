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

// exp([r]) w / |w| with every component to an ulp, also a small one whose terms cancel (a direction near the axis of a
// narrow lobe); in doubled precision for |r| <= 8 and slow, as RotationMatrix beyond. For comparisons with tables, not
// for inner loops. Domain: w != 0, |w| neither subnormal nor near overflow.
Vec3 RotatedDirectionToTheUlp(const Vec3& r, const Vec3& w);

}  // namespace lobefit
