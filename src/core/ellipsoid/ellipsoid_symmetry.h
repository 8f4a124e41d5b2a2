// Which parameters are the same ellipsoid distribution, and in which directions of parameter space nothing changes.
//
// [Walter] ellipsoid NDF, eq 1-3; the identities are those of MATH.md section 5. Every function but the mirror image
// and the turn returns parameters of the same distribution.
#pragma once

#include <array>
#include <vector>

#include "lobefit/core/ellipsoid/ellipsoid.h"

namespace lobefit {

// 1 >= alpha_x >= alpha_y, third axis on the upper side, theta_z in (-pi/2, pi/2]; where axes are equal, the fixed
// choice of angles of off_center.h. Any alphas > 0, any angles. The form for reports.
Ellipsoid CanonicalEllipsoid(const Ellipsoid& ellipsoid);

// The same alphas with theta_x in (-pi/2, pi/2], theta_y in [-pi/2, pi/2], theta_z in (-pi/2, pi/2]: by
// theta_x -> theta_x + pi; (theta_y, theta_z) -> (pi - theta_y, theta_z + pi); (theta_x, theta_y, theta_z) ->
// (-theta_x, -theta_y, theta_z + pi).
Ellipsoid FoldAngles(const Ellipsoid& ellipsoid);

// alpha_x and alpha_y exchanged.
Ellipsoid SwapAxes(const Ellipsoid& ellipsoid);

// The x (0) or y (1) axis becomes the third one, whose alpha is 1: (alpha_x, alpha_y, 1) ~ (alpha_y, 1, alpha_x) /
// alpha_x or (1, alpha_x, alpha_y) / alpha_y. Alphas above 1 are legal.
Ellipsoid PromoteAxis(const Ellipsoid& ellipsoid, int axis);

// The parameters of the same distribution that are nearest to `to` by the logarithms of the alphas and the angles, of
// the half turn (-theta_x, -theta_y, theta_z + pi), the exchanged axes and full turns of theta_z.
Ellipsoid NearestEllipsoid(const Ellipsoid& ellipsoid, const Ellipsoid& to);

// The distribution seen in a mirror that reverses y: D(m_x, -m_y, m_z; mirrored) = D(m).
Ellipsoid MirrorY(const Ellipsoid& ellipsoid);

// The distribution of a sample turned by `angle` radians about the normal, counter-clockwise seen from +z.
Ellipsoid TurnAboutNormal(const Ellipsoid& ellipsoid, double angle);

// The normal where D is largest, and that value: the axis with the largest alpha (1 for canonical parameters), turned
// to the upper side; D_max = alpha_max^4 / (pi alpha_x alpha_y |A n|). It differs from the mean normal, along which P22
// peaks.
Vec3 EllipsoidPeak(const Ellipsoid& ellipsoid, double* D_max = nullptr);

// Directions of parameter space (unit vectors in the order of Ellipsoid) along which D does not change to first order,
// because two axes agree to `tolerance` of their length (alpha_x = alpha_y, alpha_x = 1, alpha_y = 1: one each, alpha_x
// = alpha_y = 1: three) or |cos theta_y| <= tolerance (gimbal lock). Empty where all five parameters are determined.
std::vector<std::array<double, kEllipsoidParameters>> FlatDirections(const Ellipsoid& ellipsoid,
                                                                     double tolerance = 1e-9);

}  // namespace lobefit
