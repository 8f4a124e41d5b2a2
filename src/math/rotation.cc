#include "lobefit/math/rotation.h"

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

}  // namespace

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
