// Slope distributions of Beckmann and GGX: isotropic, anisotropic, correlated, off-centre; P22 and the normal
// distribution D.
//
// [Heitz] Heitz 2014, eq 61-67, 70, 78-84, 87-95. Changed from print: the quadratic form of eq 95 as a sum of squares,
//   |m~|^2 = ((X/ax - Y/ay)^2 / (1 - r) + (X/ax + Y/ay)^2 / (1 + r)) / 2,
// which keeps its digits for correlations near +-1; Beckmann's exponent has the minus sign that eq 81 lost.
// Slopes are (-m_x / m_z, -m_y / m_z). alpha_x, alpha_y > 0 are those of slope space (equal to the ellipsoid's only for
// a centred, uncorrelated lobe); |r| < 1. Gradients are in the order alpha_x, alpha_y, r, slope_x, slope_y; null skips
// them, the value is the same bits either way.
#pragma once

#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/core/radial/family.h"
#include "lobefit/math/vec.h"

namespace lobefit {

inline constexpr int kSlopeParameters = 5;

// r = 0 and a zero mean slope give the centred anisotropic distribution, alpha_x = alpha_y besides the isotropic one.
struct SlopeDistribution {
  Family family = Family::kGgx;  // or kBeckmann
  double alpha_x = 1.0, alpha_y = 1.0, r = 0.0, slope_x = 0.0, slope_y = 0.0;
};

// The same ellipse as mean slope and Q^-1, and back; jacobian as in off_center.h, inputs and outputs in each struct's
// order.
OffCenter OffCenterFromSlopes(const SlopeDistribution& s, double jacobian[25] = nullptr);
SlopeDistribution SlopesFromOffCenter(Family family, const OffCenter& off_center);

// The parts of every density that depends on the squared distance from the mean alone. Q = |m~|^2 [eq 95] of an offset
// (X, Y) from the mean (times any common factor, whose square Q then has), its derivatives in X, Y and r.
struct SlopeQuadratic {
  double X, Y, value, dX, dY, dr;
};
SlopeQuadratic EvaluateSlopeQuadratic(const SlopeDistribution& s, double X, double Y);
// 1 / (pi alpha_x alpha_y sqrt(1 - r^2)).
double SlopeNormalisation(const SlopeDistribution& s);
// Gradient of value = SlopeNormalisation h(Q) with slope = SlopeNormalisation h'(Q); `weight` is dX / dslope_x.
void FillSlopeGradient(const SlopeDistribution& s, const SlopeQuadratic& q, double value, double slope, double weight,
                       double* gradient);

// Density of slopes, int P22 dx dy = 1.
double SlopeP22(const SlopeDistribution& s, double x, double y, double* gradient = nullptr);

// D(wm) = P22 / wm.z^4 [eq 64], 1/sr; 0 for wm.z <= 0. dD_dwm: derivative in the components as free variables.
double SlopeDistributionD(const SlopeDistribution& s, const Vec3& wm, double* gradient = nullptr,
                          Vec3* dD_dwm = nullptr);

// Definition of D as printed (eq 64, 70/84, 67/81, 95) for any scalar; p = alpha_x, alpha_y, r, slope_x, slope_y.
template <class T>
T SlopeDistributionDFormula(Family family, const T* p, const Vec3T<T>& m) {
  using std::exp;
  using std::sqrt;
  if (m.z <= 0.0) return T(0.0);
  const T x = m.x / m.z + p[3], y = m.y / m.z + p[4];
  const T one_minus_rr = T(1.0) - p[2] * p[2];
  const T norm2 = (x * x * p[1] * p[1] + y * y * p[0] * p[0] - T(2.0) * x * y * p[2] * p[0] * p[1]) /
                  (p[0] * p[0] * p[1] * p[1] * one_minus_rr);
  const T scale = T(kInvPi) / (p[0] * p[1] * sqrt(one_minus_rr));
  const T p22 = family == Family::kBeckmann ? scale * exp(-norm2) : scale / ((T(1.0) + norm2) * (T(1.0) + norm2));
  return p22 / (m.z * m.z * m.z * m.z);
}

}  // namespace lobefit
