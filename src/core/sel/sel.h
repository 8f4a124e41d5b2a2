// Squared spheroidal and squared ellipsoidal lobes [SEL]: a lobe on the sphere whose square root is the distance from
// the origin to an ellipsoid. Lobe space has the lobe's axis as +z; v = R w with R = exp([rotation]) takes a direction
// w there.
//
// The ellipsoid: centre (0, 0, (1 - A)/2), semi-axes (alpha_x, alpha_y, (1 + A)/2), A = max(alpha_x, alpha_y)^2; it
// reaches 1 along the axis. Domain: alpha_x, alpha_y in (0, 1]. Then 0 < K <= 1, K = 1 at the axis and A^2 opposite to
// it, K <= Ssl(sqrt(A)).
//
// max() makes a kink at alpha_x == alpha_y: the derivatives by the alphas do not exist there, see SelKink. K itself and
// every other derivative are smooth.
#pragma once

#include "lobefit/math/vec.h"

namespace lobefit {

// What the derivatives by alpha_x and alpha_y are where alpha_x == alpha_y (the argument has no effect elsewhere): NaN,
// or the one-sided gradient of the side on which the named one is the larger. The right derivative by alpha_x is
// dalpha_x of kAlphaXLarger, the left one that of kAlphaYLarger. A solver that crosses the kink should ask for one side
// and never for NaN.
enum class SelKink { kNone, kAlphaXLarger, kAlphaYLarger };

// Squared spheroidal lobe 4 a^4 / ((1 - cos) + a^2 (1 + cos))^2 at the angle theta from the axis, [SEL] first equation
// (unnumbered), as a^4 / (sin^2(theta/2) + a^2 cos^2(theta/2))^2, which does not cancel. alpha in (0, 1], theta in [0,
// pi]. Null derivative: skipped.
double Ssl(double alpha, double theta, double* dK_dalpha = nullptr, double* dK_dtheta = nullptr);
template <class T>
T SslFormula(const T& alpha, const T& theta);

// Derivatives of K in lobe space. dv is the gradient of K as a function of the three components of v, homogeneous of
// degree -2 (its component along v is -2 K; the part across v is the derivative on the sphere).
struct SelLobeGradient {
  double dalpha_x, dalpha_y;
  Vec3 dv;
};

// Squared ellipsoidal lobe K at the unit direction v of lobe space, [SEL] last equation, in the cancellation-free form:
// with q = v_x^2/alpha_x^2 + v_y^2/alpha_y^2, U = sqrt(A q + v_z^2) and, above the equator, s = U + v_z: K = (2 / (q/s
// + s))^2; below it s = U - v_z: K = (2 / (A q/s + s/A))^2. The printed sum (U - v_z) + A (U + v_z) loses up to 8
// digits near the axis.
double SelLobe(double alpha_x, double alpha_y, const Vec3& v, SelLobeGradient* gradient = nullptr,
               SelKink kink = SelKink::kNone);
template <class T>
T SelLobeFormula(const T& alpha_x, const T& alpha_y, const Vec3T<T>& v);

// Derivatives of a quantity of a rotated lobe: by the alphas, by the rotation vector, and by the components of the
// world direction.
struct SelGradient {
  double dalpha_x, dalpha_y;
  Vec3 drotation;
  Vec3 ddirection;
};

// K at the unit world direction w of a lobe with rotation vector `rotation` (radians; rows of the matrix are the lobe's
// axes).
double Sel(double alpha_x, double alpha_y, const Vec3& rotation, const Vec3& w, SelGradient* gradient = nullptr,
           SelKink kink = SelKink::kNone);

// Integral of K over the sphere: 4 pi alpha^2 for equal alphas, larger than 4 pi alpha_x alpha_y otherwise. In closed
// form by Carlson's R_F and R_D: 2 pi alpha_x alpha_y c (2 R_F - 2/3 R_D b^2), c = (1+A)/2, b = (1-A)/2, arguments
// (alpha_x^2, alpha_y^2, c^2): twice the Newtonian potential of the solid ellipsoid at the origin. Not in the paper
// (MATH.md section 1).
double SelIntegral(double alpha_x, double alpha_y, double* dintegral_dalpha_x = nullptr,
                   double* dintegral_dalpha_y = nullptr, SelKink kink = SelKink::kNone);

// The ellipsoid itself, in lobe space.
struct SelEllipsoid {
  Vec3 center, semi_axes;
};
SelEllipsoid SelEllipsoidOf(double alpha_x, double alpha_y);

// A point origin + t direction of the ellipsoid, and how t moves with the alphas.
struct SelHit {
  double t, dt_dalpha_x, dt_dalpha_y;
};
// The two intersections of the line origin + t direction (lobe space, direction of any length) with the ellipsoid,
// near.t <= far.t; false, and nothing written, where the line misses or only touches. From the origin of lobe space,
// far.t = sqrt(K(direction)).
bool SelIntersect(double alpha_x, double alpha_y, const Vec3& origin, const Vec3& direction, SelHit* near, SelHit* far,
                  SelKink kink = SelKink::kNone);

template <class T>
T SslFormula(const T& alpha, const T& theta) {
  using std::cos;
  using std::sin;
  const T s = sin(0.5 * theta), c = cos(0.5 * theta);
  const T ratio = alpha * alpha / (s * s + alpha * alpha * c * c);
  return ratio * ratio;
}

template <class T>
T SelLobeFormula(const T& alpha_x, const T& alpha_y, const Vec3T<T>& v) {
  using std::sqrt;
  const T alpha_max = alpha_x < alpha_y ? alpha_y : alpha_x;
  const T a = alpha_max * alpha_max;
  const T px = v.x / alpha_x, py = v.y / alpha_y;
  const T q = px * px + py * py;
  const T u = sqrt(a * q + v.z * v.z);
  T inverse_distance;  // twice the inverse of the distance to the ellipsoid
  if (v.z < 0.0) {
    const T s = u - v.z;
    inverse_distance = a * q / s + s / a;
  } else {
    const T s = u + v.z;
    inverse_distance = q / s + s;
  }
  return 4.0 / (inverse_distance * inverse_distance);
}

}  // namespace lobefit
