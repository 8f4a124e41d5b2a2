// The ellipsoid normal distribution: value and gradient of D, projected area and masking.
//
// [Walter] Walter, Dong, Marschner, Greenberg: The Ellipsoid Normal Distribution Function, supplemental material.
// [Loubet] Loubet et al., supplemental material.
//
// A = S R, S = diag(alpha_x, alpha_y, 1), R = Rx(theta_x) Ry(theta_y) Rz(theta_z) maps world to ellipsoid frame [Walter
// eq 2-3]. Signs: theta_y > 0 leans the lobe to -x, theta_x > 0 leans it to +y, theta_z > 0 turns the anisotropy
// clockwise seen from +z. Directions are unit vectors, away from the surface, n = +z; a caller whose input is unit only
// to rounding normalises it first. Gradients are in the order alpha_x, alpha_y, theta_x, theta_y, theta_z; a null
// pointer skips them, the value is the same bits either way. Alphas > 0 (values above 1 are legal), any finite angle.
#pragma once

#include <array>

#include "lobefit/math/vec.h"

namespace lobefit {

// Alphas without unit, angles in radians.
struct Ellipsoid {
  double alpha_x = 1.0, alpha_y = 1.0, theta_x = 0.0, theta_y = 0.0, theta_z = 0.0;
};

inline constexpr int kEllipsoidParameters = 5;

// R of [Walter eq 3]; p = alpha_x, alpha_y, theta_x, theta_y, theta_z. Row k is the k-th axis of the ellipsoid in the
// world.
template <class T>
Mat3T<T> EllipsoidRotation(const T* p) {
  using std::cos;
  using std::sin;
  const T cx = cos(p[2]), sx = sin(p[2]), cy = cos(p[3]), sy = sin(p[3]), cz = cos(p[4]), sz = sin(p[4]);
  return {{{{cy * cz, -cy * sz, sy},
            {cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy},
            {sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy}}}};
}
Mat3 EllipsoidRotation(const Ellipsoid& ellipsoid);

// D(wm), 1/sr, int D(m) (m.n) dm = 1 over the upper hemisphere [Walter eq 1]; 0 where wm.z < 0. The gradient with
// respect to the components of wm (as free variables, degree -4) goes to dD_dwm.
double EllipsoidD(const Ellipsoid& ellipsoid, const Vec3& wm, double* gradient = nullptr, Vec3* dD_dwm = nullptr);

// sigma(u) = int D(m) <m.u> dm = A_l(u, n) / A_e(n) [Walter eq 26, 29; the denominator of Loubet eq 1], projected area
// of the visible microsurface per macro area, any u on the sphere. Changed from print: the stable form for Au.An < 0.
double EllipsoidSigma(const Ellipsoid& ellipsoid, const Vec3& u, double* gradient = nullptr, Vec3* dsigma_du = nullptr);

// |u.n| / sigma(u), [Walter eq 6] without its minimum: exceeds 1 on part of the hemisphere of a leaning lobe, by
// construction.
double EllipsoidG1Unclamped(const Ellipsoid& ellipsoid, const Vec3& u, double* gradient = nullptr);

// min(1, |u.n| / sigma(u)) [Walter eq 6; Loubet eq 1]. A kink of the model: where the quotient exceeds 1 the
// value is 1, the gradient 0, and `clamped` is set. The caller applies the factor X+(u.m).
double EllipsoidG1(const Ellipsoid& ellipsoid, const Vec3& u, double* gradient = nullptr, bool* clamped = nullptr);

// Cheap invariants of one ellipsoid for loops over directions: the frame, |An|^2 and its gradient.
// The functions above are these with the frame made on the spot.
class EllipsoidFrame {
 public:
  explicit EllipsoidFrame(const Ellipsoid& ellipsoid);
  double D(const Vec3& wm, double* gradient = nullptr, Vec3* dD_dwm = nullptr) const;
  double Sigma(const Vec3& u, double* gradient = nullptr, Vec3* dsigma_du = nullptr) const;
  // sigma(u) / u.z - 1 for u.z > 0 [Heitz' Lambda in the convention of Walter eq 6], without the subtraction: small
  // near the normal, and of the right sign there. Negative where the masking is clamped.
  double Lambda(const Vec3& u, double* gradient = nullptr) const;
  // Whether u.z > sigma(u), for u.z > 0: the clamp of G1. Decided without the rounding of sigma, which would be wrong
  // where the two nearly agree (a lobe that hardly leans, seen near its normal).
  bool Clamped(const Vec3& u) const;
  const Mat3& rotation() const { return rotation_; }
  // |A n|^2 = M33 and its gradient.
  double norm2_an() const { return norm2_an_; }
  const std::array<double, kEllipsoidParameters>& dnorm2_an() const { return dnorm2_an_; }
  // Axis, in the ellipsoid's frame, about which the frame turns with theta_x, theta_y, theta_z (k = 0, 1, 2).
  const Vec3& turn_axis(int k) const { return turn_axis_[static_cast<std::size_t>(k)]; }

 private:
  double alpha_x_, alpha_y_;
  Mat3 rotation_;
  std::array<Vec3, 3> turn_axis_;
  double norm2_an_;
  std::array<double, kEllipsoidParameters> dnorm2_an_;
};

// Definitions for any scalar with arithmetic, the oracle of the tests: D as printed, sigma with the rationalised form
// for Au.An < 0.
template <class T>
T EllipsoidDFormula(const T* p, const Vec3T<T>& wm) {
  using std::sqrt;
  if (wm.z < 0.0) return T(0.0);
  const Mat3T<T> r = EllipsoidRotation(p);
  const Vec3T<T> v = r * wm;
  const Vec3T<T> w = {v.x / p[0], v.y / p[1], v.z};
  const Vec3T<T> an = {p[0] * r.row[0].z, p[1] * r.row[1].z, r.row[2].z};
  const T ww = Dot(w, w);
  return T(kInvPi) / (p[0] * p[1] * Norm(an) * ww * ww);
}

template <class T>
T EllipsoidSigmaFormula(const T* p, const Vec3T<T>& u) {
  const Mat3T<T> r = EllipsoidRotation(p);
  const Vec3T<T> v = r * u;
  const Vec3T<T> au = {p[0] * v.x, p[1] * v.y, v.z};
  const Vec3T<T> an = {p[0] * r.row[0].z, p[1] * r.row[1].z, r.row[2].z};
  const T d = Dot(au, an), nn = Dot(an, an);
  const Vec3T<T> e = r * Vec3T<T>{u.y, -u.x, T(0.0)};  // Au x An = S* R (u x n)
  const Vec3T<T> cross = {p[1] * e.x, p[0] * e.y, p[0] * p[1] * e.z};
  const T norms = Norm(au) * Norm(an);
  if (d < 0.0) return Dot(cross, cross) / (T(2.0) * nn * (norms - d));
  return (norms + d) / (T(2.0) * nn);
}

}  // namespace lobefit
