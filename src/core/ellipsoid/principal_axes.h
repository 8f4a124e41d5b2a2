// Principal axes of the ellipsoid x^T B^T B x = const by one-sided Jacobi rotations of the rows of B. Unlike an
// eigen-decomposition of B^T B it keeps the full relative accuracy of short axes next to long ones.
#pragma once

#include <array>

#include "lobefit/math/vec.h"

namespace lobefit {

// rotation * B = diag(length) * axes: row k of `axes` is a unit vector, rows are perpendicular, lengths descend,
// `rotation` is orthogonal. Signs are not fixed.
struct PrincipalAxes {
  std::array<double, 3> length;
  Mat3 axes;
  Mat3 rotation;
};

// B regular. The relative error of every length and axis is that of B's rows scaled to unit length (times the inverse
// of relative gaps for axes), whatever the ratio of the lengths [Demmel and Veselic 1992].
PrincipalAxes FindPrincipalAxes(const Mat3& b);

}  // namespace lobefit
