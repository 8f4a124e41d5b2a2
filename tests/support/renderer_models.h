// The models of renderers, written here anew from their documents and by other routes than the program's: complex
// Fresnel amplitudes, masking by the tangent of the effective angle.
#pragma once

#include <cmath>
#include <complex>
#include <string>

#include "lobefit/math/vec.h"

namespace lobefit::test {

inline double SchlickFresnel(double f0, double c) { return f0 + (1 - f0) * std::pow(1 - c, 5); }

// Fresnel's equations by complex amplitudes.
inline double ComplexFresnel(double eta, double k, double c) {
  const std::complex<double> n(eta, k), sin_t = std::sqrt(1 - c * c) / n, cos_t = std::sqrt(1.0 - sin_t * sin_t);
  const std::complex<double> s = (c - n * cos_t) / (c + n * cos_t), p = (n * c - cos_t) / (n * c + cos_t);
  return (std::norm(s) + std::norm(p)) / 2;
}

struct Frame {
  Vec3 t, b, n;
  Vec3 Local(const Vec3& w) const { return {Dot(w, t), Dot(w, b), Dot(w, n)}; }
};
inline Frame TurnedFrame(double angle, const Vec3& n) {
  Vec3 t = {std::cos(angle), std::sin(angle), 0};
  t = Normalized(t - Dot(t, n) * n);
  return {t, Cross(n, t), n};
}

// Trowbridge-Reitz by angles: tan^2 theta (cos^2 phi / ax^2 + sin^2 phi / ay^2).
inline double TrowbridgeReitz(const Vec3& h, double ax, double ay) {
  const double tan2 = (1 - h.z * h.z) / (h.z * h.z), r2 = h.x * h.x + h.y * h.y;
  const double e = r2 > 0 ? tan2 * (h.x * h.x / r2 / (ax * ax) + h.y * h.y / r2 / (ay * ay)) : 0;
  return 1 / (kPi * ax * ay * std::pow(h.z, 4) * (1 + e) * (1 + e));
}
inline double Lambda(const Vec3& w, double ax, double ay) {
  const double tan2 = (1 - w.z * w.z) / (w.z * w.z), r2 = w.x * w.x + w.y * w.y;
  const double alpha2 = r2 > 0 ? (ax * ax * w.x * w.x + ay * ay * w.y * w.y) / r2 : 0;
  return (std::sqrt(1 + alpha2 * tan2) - 1) / 2;
}

// The lobe's factor of everything but Fresnel, seen from the surface below a shading normal.
inline double LobeFactor(const Frame& frame, double ax, double ay, const Vec3& wi, const Vec3& wo,
                         const std::string& masking) {
  const Vec3 i = frame.Local(wi), o = frame.Local(wo);
  if (i.z <= 0 || o.z <= 0) return 0;
  const Vec3 h = Normalized(i + o);
  const double mean = std::sqrt(ax * ay);
  double g = 1 / ((1 + Lambda(i, ax, ay)) * (1 + Lambda(o, ax, ay)));
  if (masking == "correlated") g = 1 / (1 + Lambda(i, ax, ay) + Lambda(o, ax, ay));
  if (masking == "mean") g = 1 / (1 + Lambda(i, mean, mean) + Lambda(o, mean, mean));
  return TrowbridgeReitz(h, ax, ay) * g / (4 * i.z * o.z) * (i.z / wi.z);
}

// Albedo of an isotropic lobe of Schlick's term by a plain product rule over the micro normals.
inline double LobeAlbedo(double alpha, double mu, double f0 = 1, int side = 400) {
  const Vec3 o = {std::sqrt(1 - mu * mu), 0, mu};
  double sum = 0;

  for (int a = 0; a < side; ++a) {
    for (int b = 0; b < side; ++b) {
      const double u = (a + 0.5) / side, phi = 2 * kPi * (b + 0.5) / side, tan = alpha * std::sqrt(u / (1 - u));
      const Vec3 h = Normalized(Vec3{tan * std::cos(phi), tan * std::sin(phi), 1});
      const double oh = Dot(o, h);
      const Vec3 i = 2 * oh * h - o;
      if (oh <= 0 || i.z <= 0) continue;
      // dwi = 4 oh dh, and u is uniform with density D cos_h.
      sum += SchlickFresnel(f0, oh) * 4 * oh / (h.z * 4 * mu) / (1 + Lambda(i, alpha, alpha) + Lambda(o, alpha, alpha));
    }
  }
  return sum / (side * side);
}

}  // namespace lobefit::test
