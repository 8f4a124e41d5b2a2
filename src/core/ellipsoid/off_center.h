// The ellipsoid distribution as an off-centre, correlated GGX in slope space, and back: exact, one to one.
//
// [Walter] ellipsoid NDF, eq 1-3; [Heitz] Heitz 2014, eq 88-95; [Loubet] sec 2. Formulas: both papers' matrices agree
// through M = A^T A = M33 [[Q^-1 + s s^T, -s], [-s^T, 1]] with mean slope s and Q^-1 = [[alpha'_x^2, r alpha'_x
// alpha'_y], [., alpha'_y^2]]. Changed from print: Q^-1 by cofactors of A, the inverse by one-sided Jacobi rotations,
// neither of which subtracts near equals.
#pragma once

#include "lobefit/core/ellipsoid/ellipsoid.h"

namespace lobefit {

// Mean slope and Q^-1 (symmetric, positive definite). A positive mean slope x is a mean normal that leans to -x.
struct OffCenter {
  double slope_x = 0.0, slope_y = 0.0, q11 = 1.0, q12 = 0.0, q22 = 1.0;
};

// Fitting coordinates: v = slope_x, slope_y, ln a, b, ln c where Q^-1 = L L^T, L = [[a, 0], [b, c]]. Any five finite
// numbers are a distribution, every distribution is one point, and the map is smooth where the ellipsoid's angles are
// not.
struct SlopeCoordinates {
  double v[5] = {0.0, 0.0, 0.0, 0.0, 0.0};
};

// Every `jacobian` is row-major 5 x 5, d(output k) / d(input j) at [5 k + j]; null skips it.
// From an ellipsoid: alphas > 0, tilt short of 90 degrees only insofar as M33 > 0, which holds for any alphas > 0.
OffCenter OffCenterFromEllipsoid(const Ellipsoid& ellipsoid, double jacobian[25] = nullptr);
SlopeCoordinates SlopeCoordinatesFromEllipsoid(const Ellipsoid& ellipsoid, double jacobian[25] = nullptr);

// Canonical form: 1 >= alpha_x >= alpha_y, third axis on the upper side, theta_z in (-pi/2, pi/2]. Where two axes are
// equal to 32 eps the angles are not determined: a fixed choice is made (theta_z = 0 if alpha_x = alpha_y; theta_y = 0
// if alpha_x = 1) and the whole Jacobian is NaN, because sorted axes have a kink there. Through SlopeCoordinates a
// round trip keeps 1e-12 down to alphas of 1e-4; OffCenter itself stores Q^-1, whose smaller eigenvalue carries only
// eps (alpha'_max / alpha'_min)^2. Throws InputError if Q^-1 is not finite and positive definite.
Ellipsoid EllipsoidFromOffCenter(const OffCenter& off_center, double jacobian[25] = nullptr);
Ellipsoid EllipsoidFromSlopeCoordinates(const SlopeCoordinates& coordinates, double jacobian[25] = nullptr);

// q11 > 0 and q11 q22 > q12^2, else InputError.
SlopeCoordinates SlopeCoordinatesFromOffCenter(const OffCenter& off_center, double jacobian[25] = nullptr);
OffCenter OffCenterFromSlopeCoordinates(const SlopeCoordinates& coordinates, double jacobian[25] = nullptr);

// Width across the narrowest axis in slope space: the square root of the smaller eigenvalue of Q^-1.
double NarrowestWidth(const SlopeCoordinates& coordinates);

// Definition by M = A^T A, for any scalar; p as in EllipsoidRotation, out = slope_x, slope_y, q11, q12, q22.
template <class T>
void OffCenterFormula(const T* p, T* out) {
  const Mat3T<T> r = EllipsoidRotation(p);
  const auto m = [&](const T& a0, const T& a1, const T& a2, const T& b0, const T& b1, const T& b2) {
    return p[0] * p[0] * a0 * b0 + p[1] * p[1] * a1 * b1 + a2 * b2;
  };
  const Vec3T<T> c1 = {r.row[0].x, r.row[1].x, r.row[2].x}, c2 = {r.row[0].y, r.row[1].y, r.row[2].y};
  const Vec3T<T> c3 = {r.row[0].z, r.row[1].z, r.row[2].z};
  const T m33 = m(c3.x, c3.y, c3.z, c3.x, c3.y, c3.z);
  out[0] = -m(c1.x, c1.y, c1.z, c3.x, c3.y, c3.z) / m33;
  out[1] = -m(c2.x, c2.y, c2.z, c3.x, c3.y, c3.z) / m33;
  out[2] = m(c1.x, c1.y, c1.z, c1.x, c1.y, c1.z) / m33 - out[0] * out[0];
  out[3] = m(c1.x, c1.y, c1.z, c2.x, c2.y, c2.z) / m33 - out[0] * out[1];
  out[4] = m(c2.x, c2.y, c2.z, c2.x, c2.y, c2.z) / m33 - out[1] * out[1];
}

}  // namespace lobefit
