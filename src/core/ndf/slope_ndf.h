// The ellipsoid distribution (off-centre, correlated GGX) evaluated in the fitting coordinates.
//
// [Heitz] Heitz 2014, eq 64, 84, 95-97; [Loubet] eq 1 and sec 2; MATH.md section 6: with Q^-1 = L L^T, L = [[a, 0], [b,
// c]],
//   y = L^-1 ((-h_x, -h_y) - h_z mean),   D(h) = 1 / (pi a c (h_z^2 + |y|^2)^2),
//   c_u = u_z - mean.u_xy,  q = |L^T u_xy|^2,  sigma(u) = (c_u + sqrt(c_u^2 + q)) / 2.
// Changed from print: sigma for c_u < 0 without the subtraction. Equal to ellipsoid.h through off_center.h.
// Directions are unit vectors away from the surface, n = +z. Gradients are in the order slope_x, slope_y, ln a, b, ln
// c; a null pointer skips them, the value is the same bits either way.
#pragma once

#include "lobefit/core/ellipsoid/off_center.h"

namespace lobefit {

// SlopeCoordinates with the exponentials taken once, for loops over directions.
struct SlopeFrame {
  explicit SlopeFrame(const SlopeCoordinates& coordinates);
  double slope_x, slope_y, a, b, c;
};

// D(wm), 1/sr; 0 where wm.z < 0. dD_dwm: derivative in the components of wm as free variables.
double SlopeD(const SlopeFrame& frame, const Vec3& wm, double* gradient = nullptr, Vec3* dD_dwm = nullptr);

// sigma(u) = int D(m) <m.u> dm, any u on the sphere; not differentiable at q = 0, c_u <= 0 (u = -n) only.
double SlopeSigma(const SlopeFrame& frame, const Vec3& u, double* gradient = nullptr, Vec3* dsigma_du = nullptr);

// |u.n| / sigma(u), may exceed 1; dG1_du as above, for u.z > 0.
double SlopeG1Unclamped(const SlopeFrame& frame, const Vec3& u, double* gradient = nullptr, Vec3* dG1_du = nullptr);

// min(1, |u.n| / sigma(u)) [Loubet eq 1]: a kink of the model; where the quotient exceeds 1 the value is 1, derivatives
// are 0 and `clamped` is set. Clamped exactly where q < 4 u_z (mean.u_xy).
double SlopeG1(const SlopeFrame& frame, const Vec3& u, double* gradient = nullptr, Vec3* dG1_du = nullptr,
               bool* clamped = nullptr);

// Definitions for any scalar; v = slope_x, slope_y, ln a, b, ln c.
template <class T>
T SlopeDFormula(const T* v, const Vec3T<T>& h) {
  using std::exp;
  if (h.z < 0.0) return T(0.0);
  const T y1 = (-h.x - v[0] * h.z) * exp(-v[2]);
  const T y2 = (-h.y - v[1] * h.z - v[3] * y1) * exp(-v[4]);
  const T t = h.z * h.z + y1 * y1 + y2 * y2;
  return T(kInvPi) * exp(-v[2] - v[4]) / (t * t);
}

template <class T>
T SlopeSigmaFormula(const T* v, const Vec3T<T>& u) {
  using std::exp;
  using std::sqrt;
  const T c = u.z - v[0] * u.x - v[1] * u.y;
  const T l1 = exp(v[2]) * u.x + v[3] * u.y, l2 = exp(v[4]) * u.y;
  const T q = l1 * l1 + l2 * l2;
  const T s = sqrt(c * c + q);
  if (c < 0.0) return q / (T(2.0) * (s - c));
  return (c + s) / T(2.0);
}

}  // namespace lobefit
