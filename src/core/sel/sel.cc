#include "lobefit/core/sel/sel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/math/carlson.h"
#include "lobefit/math/rotation.h"

namespace lobefit {
namespace {

// A = max(alpha)^2 and its derivatives, which are NaN at the kink unless a side is chosen.
struct LargerSquare {
  double a, da_dx, da_dy;
};

LargerSquare LargerAlphaSquare(double alpha_x, double alpha_y, SelKink kink) {
  const double larger = std::fmax(alpha_x, alpha_y);
  LargerSquare result{larger * larger, 0, 0};
  if (alpha_x == alpha_y && kink == SelKink::kNone) {
    result.da_dx = result.da_dy = std::numeric_limits<double>::quiet_NaN();
  } else if (alpha_x > alpha_y || (alpha_x == alpha_y && kink == SelKink::kAlphaXLarger)) {
    result.da_dx = 2 * larger;
  } else {
    result.da_dy = 2 * larger;
  }
  return result;
}

// A number with derivatives by alpha_x and alpha_y, for the duplication algorithm of the elliptic integrals.
struct Dual {
  double v, dx, dy;
  Dual(double value) : v(value), dx(0), dy(0) {}  // NOLINT(google-explicit-constructor): numbers mix with duals
  Dual(double value, double by_x, double by_y) : v(value), dx(by_x), dy(by_y) {}
};
Dual operator-(const Dual& a) { return {-a.v, -a.dx, -a.dy}; }
Dual operator+(const Dual& a, const Dual& b) { return {a.v + b.v, a.dx + b.dx, a.dy + b.dy}; }
Dual operator-(const Dual& a, const Dual& b) { return {a.v - b.v, a.dx - b.dx, a.dy - b.dy}; }
Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.v * b.dx + a.dx * b.v, a.v * b.dy + a.dy * b.v}; }
Dual operator/(const Dual& a, const Dual& b) {
  const double value = a.v / b.v;
  return {value, (a.dx - value * b.dx) / b.v, (a.dy - value * b.dy) / b.v};
}
Dual sqrt(const Dual& a) {
  const double root = std::sqrt(a.v);
  return {root, 0.5 * a.dx / root, 0.5 * a.dy / root};
}
bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }

template <class T>
T IntegralFormula(const T& alpha_x, const T& alpha_y, const T& a) {
  const T half_length = 0.5 * (1.0 + a), offset = 0.5 * (1.0 - a);
  const T x = alpha_x * alpha_x, y = alpha_y * alpha_y, z = half_length * half_length;
  return 2.0 * kPi * alpha_x * alpha_y * half_length *
         (2.0 * CarlsonRF(x, y, z) - 2.0 / 3.0 * CarlsonRD(x, y, z) * offset * offset);
}

}  // namespace

double Ssl(double alpha, double theta, double* dK_dalpha, double* dK_dtheta) {
  const double s = std::sin(0.5 * theta), c = std::cos(0.5 * theta);
  const double square = alpha * alpha;
  const double den = s * s + square * c * c;
  const double ratio = square / den;
  if (dK_dalpha != nullptr) *dK_dalpha = 4 * ratio * alpha * s * s / (den * den);
  if (dK_dtheta != nullptr) *dK_dtheta = -2 * ratio * ratio * s * c * (1 - alpha) * (1 + alpha) / den;
  return ratio * ratio;
}

double SelLobe(double alpha_x, double alpha_y, const Vec3& v, SelLobeGradient* gradient, SelKink kink) {
  const LargerSquare larger = LargerAlphaSquare(alpha_x, alpha_y, kink);
  const double a = larger.a;
  const double px = v.x / alpha_x, py = v.y / alpha_y;
  const double q = px * px + py * py;
  const double u = std::sqrt(a * q + v.z * v.z);
  const bool below = v.z < 0;
  const double s = below ? u - v.z : u + v.z;
  const double g = below ? a * q / s + s / a : q / s + s;  // twice the inverse distance to the ellipsoid
  const double k = 4 / (g * g);
  if (gradient != nullptr) {
    // dg for a change (da, dq, dz) of the three quantities that g depends on; dK = -2 K dg / g.
    const double sign = below ? -1 : 1;
    const auto slope = [&](double da, double dq, double dz) {
      const double ds = (0.5 * (da * q + a * dq) + v.z * dz) / u + sign * dz;
      const double dg = below ? (da * q + a * dq) / s - a * q / (s * s) * ds + ds / a - s * da / (a * a)
                              : dq / s - q / (s * s) * ds + ds;
      return -2 * k / g * dg;
    };
    gradient->dalpha_x = slope(larger.da_dx, -2 * px * px / alpha_x, 0);
    gradient->dalpha_y = slope(larger.da_dy, -2 * py * py / alpha_y, 0);
    gradient->dv = {slope(0, 2 * px / alpha_x, 0), slope(0, 2 * py / alpha_y, 0), slope(0, 0, 1)};
  }
  return k;
}

double Sel(double alpha_x, double alpha_y, const Vec3& rotation, const Vec3& w, SelGradient* gradient, SelKink kink) {
  const Mat3 r = RotationMatrix(rotation);
  const Vec3 v = r * w;
  if (gradient == nullptr) return SelLobe(alpha_x, alpha_y, v);
  SelLobeGradient lobe;
  const double k = SelLobe(alpha_x, alpha_y, v, &lobe, kink);
  gradient->dalpha_x = lobe.dalpha_x;
  gradient->dalpha_y = lobe.dalpha_y;
  gradient->drotation = Transposed(RotationLeftJacobian(rotation)) * Cross(v, lobe.dv);
  gradient->ddirection = Transposed(r) * lobe.dv;
  return k;
}

double SelIntegral(double alpha_x, double alpha_y, double* dintegral_dalpha_x, double* dintegral_dalpha_y,
                   SelKink kink) {
  const LargerSquare larger = LargerAlphaSquare(alpha_x, alpha_y, kink);
  if (dintegral_dalpha_x != nullptr || dintegral_dalpha_y != nullptr) {
    const Dual integral =
        IntegralFormula(Dual(alpha_x, 1, 0), Dual(alpha_y, 0, 1), Dual(larger.a, larger.da_dx, larger.da_dy));
    if (dintegral_dalpha_x != nullptr) *dintegral_dalpha_x = integral.dx;
    if (dintegral_dalpha_y != nullptr) *dintegral_dalpha_y = integral.dy;
  }
  return IntegralFormula(alpha_x, alpha_y, larger.a);
}

SelEllipsoid SelEllipsoidOf(double alpha_x, double alpha_y) {
  const double larger = std::fmax(alpha_x, alpha_y);
  const double a = larger * larger;
  return {{0, 0, 0.5 * (1 - larger) * (1 + larger)}, {alpha_x, alpha_y, 0.5 * (1 + a)}};
}

bool SelIntersect(double alpha_x, double alpha_y, const Vec3& origin, const Vec3& direction, SelHit* near, SelHit* far,
                  SelKink kink) {
  const LargerSquare larger = LargerAlphaSquare(alpha_x, alpha_y, kink);
  const SelEllipsoid ellipsoid = SelEllipsoidOf(alpha_x, alpha_y);
  const Vec3 &center = ellipsoid.center, &axes = ellipsoid.semi_axes;
  const Vec3 o = {origin.x / axes.x, origin.y / axes.y, (origin.z - center.z) / axes.z};
  const Vec3 d = {direction.x / axes.x, direction.y / axes.y, direction.z / axes.z};
  const double dd = Dot(d, d), od = Dot(o, d);
  // |o|^2 - 1 with the z part factored: next to the ellipsoid's ends, 1 and -A, the difference of squares would cancel.
  const double oo = o.x * o.x + o.y * o.y + (origin.z - 1) * (origin.z + larger.a) / (axes.z * axes.z);
  const Vec3 across = Cross(o, d);
  const double discriminant = oo > 0 ? dd - Dot(across, across) : od * od - dd * oo;
  if (!(discriminant > 0)) return false;
  const double q = -(od + std::copysign(std::sqrt(discriminant), od));
  const double t0 = q / dd, t1 = oo / q;
  // F(origin + t direction; alphas) = 0: dt = -dF/dalpha / (grad F . direction). The centre moves by -da/2, the half
  // length by da/2.
  const auto hit = [&](double t) {
    const Vec3 p = o + t * d;
    const double along = Dot(p, d);
    const double length = p.z * (1 - p.z) / (2 * axes.z);  // dF/dA / 2
    return SelHit{t, (p.x * p.x / alpha_x - length * larger.da_dx) / along,
                  (p.y * p.y / alpha_y - length * larger.da_dy) / along};
  };
  if (near != nullptr) *near = hit(std::min(t0, t1));
  if (far != nullptr) *far = hit(std::max(t0, t1));
  return true;
}

}  // namespace lobefit
