// Projected areas of the ellipsoid and of its lune that faces two directions.
//
// [Walter] ellipsoid NDF, eq 24-29 with the scale C_e of eq 27, so that A_e(n) = 1. Changed from print: the stable form
// of eq 26 for A u . A v < 0 (the printed one loses all digits as v approaches -u).
#pragma once

#include "lobefit/core/ellipsoid/ellipsoid.h"

namespace lobefit {

// A_e(u) = |A u| / |A n|, area of the whole ellipsoid projected along u; any unit u. Gradient in the order of
// Ellipsoid; null skips.
double EllipsoidProjectedArea(const Ellipsoid& ellipsoid, const Vec3& u, double* gradient = nullptr);

// A_l(u, v), area, projected along u, of the part of the ellipsoid that faces both u and v: any two unit directions, 0
// at v = -u, A_e(u) at v = u. dA_du, dA_dv: derivatives in the components as free variables.
double EllipsoidLuneArea(const Ellipsoid& ellipsoid, const Vec3& u, const Vec3& v, double* gradient = nullptr,
                         Vec3* dA_du = nullptr, Vec3* dA_dv = nullptr);

// Definition for any scalar; p as in EllipsoidRotation.
template <class T>
T EllipsoidLuneAreaFormula(const T* p, const Vec3T<T>& u, const Vec3T<T>& v) {
  const Mat3T<T> r = EllipsoidRotation(p);
  const auto scaled = [&](const Vec3T<T>& w) { return Vec3T<T>{p[0] * w.x, p[1] * w.y, w.z}; };
  const Vec3T<T> au = scaled(r * u), av = scaled(r * v), an = scaled({r.row[0].z, r.row[1].z, r.row[2].z});
  const Vec3T<T> e = r * Cross(u, v);
  const Vec3T<T> cross = {p[1] * e.x, p[0] * e.y, p[0] * p[1] * e.z};
  const T d = Dot(au, av), norms = Norm(au) * Norm(av);
  const T sum = d < 0.0 ? Dot(cross, cross) / (norms - d) : norms + d;
  return sum / (T(2.0) * Norm(an) * Norm(av));
}

}  // namespace lobefit
