#include "lobefit/math/directions.h"

namespace lobefit {

Vec3 FromSpherical(double theta, double phi) {
  const double sin_theta = std::sin(theta);
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), std::cos(theta)};
}

double PolarAngle(const Vec3& w) { return std::atan2(std::hypot(w.x, w.y), w.z); }

double Azimuth(const Vec3& w) { return (w.x == 0 && w.y == 0) ? 0.0 : std::atan2(w.y, w.x); }

Vec3 HalfVector(const Vec3& wi, const Vec3& wo) { return Normalized(wi + wo); }

Vec3 Reflect(const Vec3& w, const Vec3& m) { return (2.0 * Dot(w, m)) * m - w; }

HalfDifference ToHalfDifference(const Vec3& wi, const Vec3& wo) {
  const Vec3 wh = HalfVector(wi, wo);
  const double theta_h = PolarAngle(wh);
  const double phi_h = Azimuth(wh);
  const Vec3 d = RotateY(RotateZ(wi, -phi_h), -theta_h);
  return {theta_h, phi_h, PolarAngle(d), Azimuth(d)};
}

HalfDifference ToFoldedHalfDifference(const Vec3& wi, const Vec3& wo) {
  const Vec3 wh = HalfVector(wi, wo);
  const double sin_h = std::sqrt(wh.x * wh.x + wh.y * wh.y);
  const double c = sin_h > 0 ? wh.x / sin_h : 1, s = sin_h > 0 ? wh.y / sin_h : 0;
  const double along = c * wi.x + s * wi.y, x = wh.z * along - sin_h * wi.z, y = c * wi.y - s * wi.x,
               z = sin_h * along + wh.z * wi.z;
  return {std::atan2(sin_h, wh.z), 0, std::atan2(std::sqrt(x * x + y * y), z), std::atan2(std::fabs(y), std::fabs(x))};
}

void FromHalfDifference(const HalfDifference& angles, Vec3* wi, Vec3* wo) {
  const Vec3 d = FromSpherical(angles.theta_d, angles.phi_d);
  const Vec3 d_mirrored = {-d.x, -d.y, d.z};
  *wi = RotateZ(RotateY(d, angles.theta_h), angles.phi_h);
  *wo = RotateZ(RotateY(d_mirrored, angles.theta_h), angles.phi_h);
}

Vec3 RotateZ(const Vec3& w, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * w.x - s * w.y, s * w.x + c * w.y, w.z};
}

Vec3 RotateY(const Vec3& w, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * w.x + s * w.z, w.y, -s * w.x + c * w.z};
}

Vec3 RotateX(const Vec3& w, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {w.x, c * w.y - s * w.z, s * w.y + c * w.z};
}

}  // namespace lobefit
