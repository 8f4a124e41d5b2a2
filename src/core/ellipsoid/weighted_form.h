// Weighted bilinear forms sum_k w_k p_k q_k of vectors in the frame of an ellipsoid and their derivative under a turn
// of that frame. Every quadratic in the ellipsoid's matrix (D, the projected areas, the conversion to slope space) is
// one of these, and written so neither loses digits where two axes are equal: the differences of the weights enter as
// given, not subtracted here.
#pragma once

#include <cmath>

#include "lobefit/math/vec.h"

namespace lobefit {

template <class T>
struct FormWeightsT {
  T x, y, z;
  T z_minus_y, x_minus_z, y_minus_x;
};
using FormWeights = FormWeightsT<double>;

// Weights (ax^2, ay^2, 1) of A^T A, A = S R [Walter eq 2].
template <class T>
FormWeightsT<T> ShapeWeights(const T& alpha_x, const T& alpha_y) {
  return {alpha_x * alpha_x,
          alpha_y * alpha_y,
          1.0,
          (1.0 - alpha_y) * (1.0 + alpha_y),
          -(1.0 - alpha_x) * (1.0 + alpha_x),
          (alpha_y - alpha_x) * (alpha_y + alpha_x)};
}

// Weights (ay^2, ax^2, ax^2 ay^2): squares of the cofactors of S = diag(ax, ay, 1), for |S p x S q|^2.
template <class T>
FormWeightsT<T> CofactorWeights(const T& alpha_x, const T& alpha_y) {
  const T xx = alpha_x * alpha_x, yy = alpha_y * alpha_y;
  return {yy,
          xx,
          xx * yy,
          -xx * (1.0 - alpha_y) * (1.0 + alpha_y),
          yy * (1.0 - alpha_x) * (1.0 + alpha_x),
          (alpha_x - alpha_y) * (alpha_x + alpha_y)};
}

// Weights (1/ax^2, 1/ay^2, 1) of the inverse matrix, for |A^-T m|^2.
template <class T>
FormWeightsT<T> InverseWeights(const T& alpha_x, const T& alpha_y) {
  const T xx = T(1.0) / (alpha_x * alpha_x), yy = T(1.0) / (alpha_y * alpha_y);
  return {xx,
          yy,
          1.0,
          -(1.0 - alpha_y) * (1.0 + alpha_y) * yy,
          (1.0 - alpha_x) * (1.0 + alpha_x) * xx,
          (alpha_x - alpha_y) * (alpha_x + alpha_y) * xx * yy};
}

template <class T>
T Form(const FormWeightsT<T>& w, const Vec3T<T>& p, const Vec3T<T>& q) {
  return w.x * p.x * q.x + w.y * p.y * q.y + w.z * p.z * q.z;
}

// The same for p perpendicular to q, where a multiple of p.q = 0 may be taken away: of the four forms that do so
// without a new subtraction of weights the one with the smallest terms. It keeps its digits where the weights are
// nearly equal.
template <class T>
T FormOfPerpendicular(const FormWeightsT<T>& w, const Vec3T<T>& p, const Vec3T<T>& q) {
  const T x = p.x * q.x, y = p.y * q.y, z = p.z * q.z;
  const T forms[4][3] = {{w.x * x, w.y * y, w.z * z},
                         {w.x_minus_z * x, -w.z_minus_y * y, 0.0},
                         {-w.y_minus_x * x, w.z_minus_y * z, 0.0},
                         {w.y_minus_x * y, -w.x_minus_z * z, 0.0}};
  T best = T(HUGE_VAL), value = T(0.0);
  for (const auto& form : forms) {
    const T size = std::abs(form[0]) + std::abs(form[1]) + std::abs(form[2]);
    if (size < best) {
      best = size;
      value = form[0] + form[1] + form[2];
    }
  }
  return value;
}

// Derivative of Form(w, p, q) when the frame turns about `axis` (dp = axis x p, dq = axis x q).
inline double FormTurned(const FormWeights& w, const Vec3& p, const Vec3& q, const Vec3& axis) {
  return axis.x * (p.y * q.z + p.z * q.y) * w.z_minus_y + axis.y * (p.x * q.z + p.z * q.x) * w.x_minus_z +
         axis.z * (p.x * q.y + p.y * q.x) * w.y_minus_x;
}

}  // namespace lobefit
