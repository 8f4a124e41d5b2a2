#include "lobefit/math/rotation.h"

#include <cmath>

#include "lobefit/math/special.h"

namespace lobefit {
namespace {

// I + first [r] + second [r]^2
Mat3 Polynomial(const Vec3& r, double first, double second) {
  const double xx = r.x * r.x, yy = r.y * r.y, zz = r.z * r.z;
  const double xy = second * r.x * r.y, xz = second * r.x * r.z, yz = second * r.y * r.z;
  return {{{{1 - second * (yy + zz), xy - first * r.z, xz + first * r.y},
            {xy + first * r.z, 1 - second * (xx + zz), yz - first * r.x},
            {xz - first * r.y, yz + first * r.x, 1 - second * (xx + yy)}}}};
}

// An unevaluated sum high + low, |low| <= ulp(high) / 2: about 32 digits (Dekker, Knuth).
struct Double2 {
  double high, low;
};

Double2 Sum(double a, double b) {
  const double s = a + b, t = s - a;
  return {s, (a - (s - t)) + (b - t)};
}
Double2 operator+(const Double2& a, const Double2& b) {
  const Double2 high = Sum(a.high, b.high), low = Sum(a.low, b.low);
  const Double2 once = Sum(high.high, high.low + low.high);
  return Sum(once.high, once.low + low.low);
}
Double2 operator*(const Double2& a, const Double2& b) {
  const double p = a.high * b.high;
  return Sum(p, std::fma(a.high, b.high, -p) + (a.high * b.low + a.low * b.high));
}
Double2 operator-(const Double2& a) { return {-a.high, -a.low}; }
Double2 operator-(const Double2& a, const Double2& b) { return a + -b; }
Double2 operator/(const Double2& a, double b) {
  const double q = a.high / b;
  return Sum(q, (std::fma(-q, b, a.high) + a.low) / b);
}

using Vec3D2 = Vec3T<Double2>;
Vec3D2 Doubled(const Vec3& v) { return {{v.x, 0}, {v.y, 0}, {v.z, 0}}; }

// 1 - x / (n (n + 1)) (1 - x / ((n + 2) (n + 3)) (1 - ...)): sin(t) / t for n = 2 and 2 (1 - cos(t)) / t^2 for n = 3, x
// = t^2 <= 64.
Double2 AlternatingSeries(const Double2& x, int n) {
  constexpr int kTerms = 42;
  Double2 sum = {1, 0};
  for (int k = kTerms - 1; k >= 0; --k) {
    const int m = n + 2 * k;
    sum = Double2{1, 0} - x * sum / (m * (m + 1.0));
  }
  return sum;
}

}  // namespace

Vec3 RotatedDirectionToTheUlp(const Vec3& r, const Vec3& w) {
  const Vec3D2 axis = Doubled(r), from = Doubled(w);
  const Double2 square = Dot(axis, axis);
  if (!(square.high <= 64)) return RotationMatrix(r) * Normalized(w);
  const Double2 first = AlternatingSeries(square, 2), second = AlternatingSeries(square, 3) / 2;
  const Vec3D2 across = Cross(axis, from);
  const Vec3D2 to = from + first * across + second * Cross(axis, across);
  using Real = long double;
  const Real length = std::sqrt(Real{w.x} * w.x + Real{w.y} * w.y + Real{w.z} * w.z);
  const auto component = [&](const Double2& c) { return static_cast<double>((Real{c.high} + c.low) / length); };
  return {component(to.x), component(to.y), component(to.z)};
}

Mat3 RotationMatrix(const Vec3& r) {
  const double angle = Norm(r);
  if (angle < 1e-150) return Polynomial(r, 1, 0.5);
  return Polynomial(r, std::sin(angle) / angle, OneMinusCos(angle) / (angle * angle));
}

Mat3 RotationLeftJacobian(const Vec3& r) {
  const double angle = Norm(r), square = angle * angle;
  if (angle < 1e-100) return Polynomial(r, 0.5, 1.0 / 6);
  return Polynomial(r, OneMinusCos(angle) / square, XMinusSin(angle) / (square * angle));
}

}  // namespace lobefit
