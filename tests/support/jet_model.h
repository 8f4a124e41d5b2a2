// One ellipsoid lobe on a Lambertian part and its residuals, written again for Jets: an oracle that shares no code with
// the fit.
#pragma once

#include <cmath>

#include "lobefit/fit/metric/metric.h"
#include "lobefit/math/directions.h"

namespace lobefit {

// The whole model and metric written again for Jets, in the most direct form: slope-space GGX, clamped Smith, Schlick,
// Lambert.
template <class T>
T JetModelValue(const T* u, std::size_t channel, const Vec3& wi, const Vec3& wo) {
  using std::exp;
  using std::sqrt;
  const Vec3 wh = Normalized(wi + wo);
  const T a = exp(u[2]), b = u[3], c = exp(u[4]);
  const auto sigma = [&](const Vec3& w) {
    const T cu = w.z - u[0] * w.x - u[1] * w.y;
    const T q1 = a * w.x + b * w.y, q2 = c * w.y;
    return (cu + sqrt(cu * cu + q1 * q1 + q2 * q2)) / 2.0;
  };
  const T y1 = (-wh.x - u[0] * wh.z) / a;
  const T y2 = (-wh.y - u[1] * wh.z - b * y1) / c;
  const T k = wh.z * wh.z + y1 * y1 + y2 * y2;
  const T d = 1.0 / (kPi * a * c * k * k);
  T gi = wi.z / sigma(wi), go = wo.z / sigma(wo);
  if (gi > 1.0) gi = T(1.0);
  if (go > 1.0) go = T(1.0);
  const double p = std::pow(1 - Dot(wi, wh), 5);
  const T f0 = u[5 + channel], diffuse = u[8 + channel];
  return diffuse / kPi + d * gi * go / (4 * wi.z * wo.z) * (f0 + (1.0 - f0) * p);
}

template <class T>
T JetResidual(const Transform& transform, const T& f, double m, const Vec3& wi) {
  using std::cbrt;
  using std::log;
  using std::sqrt;
  switch (transform.curve) {
    case Curve::kLogOnePlus:
      return log(1.0 + f * wi.z) - std::log1p(m * wi.z);
    case Curve::kCubeRoot:
      return cbrt(f * wi.z) - std::cbrt(m * wi.z);
    case Curve::kRelative:
      return f / m - 1.0;
    case Curve::kAsinh: {
      const T v = f * wi.z, h = sqrt(v * v + transform.knee * transform.knee);
      return log((v + h) / transform.knee) - std::asinh(m * wi.z / transform.knee) - transform.mean_shift * v / h;
    }
    case Curve::kLinear:
      break;
  }
  return (f - m) * wi.z;
}

}  // namespace lobefit
