// The material of the round trips of writers: a rigidly tilted, rotated, anisotropic GGX lobe with correlated Smith
// masking and Schlick Fresnel, and a Lambert part. Written for the tests on its own, without the core, so that readers
// and writers are tested alone.
#pragma once

#include <algorithm>
#include <cmath>

#include "lobefit/math/directions.h"

namespace lobefit {

struct TestBrdf {
  double alpha_x = 0.15, alpha_y = 0.35, rotation = 0.5, tilt = 0.25, f0 = 0.6, diffuse = 0.1;

  double operator()(const Vec3& wi, const Vec3& wo) const {
    const Vec3 wh = HalfVector(wi, wo);
    const Vec3 i = Local(wi), o = Local(wo), h = Local(wh);
    const double hx = h.x / alpha_x, hy = h.y / alpha_y, q = hx * hx + hy * hy + h.z * h.z;
    const double d = h.z <= 0 ? 0.0 : 1 / (kPi * alpha_x * alpha_y * q * q);
    const double g = i.z <= 0 || o.z <= 0 ? 0.0 : 1 / (1 + Lambda(i) + Lambda(o));
    const double fresnel = f0 + (1 - f0) * std::pow(1 - Dot(wi, wh), 5);
    return diffuse / kPi + fresnel * d * g / (4 * wi.z * wo.z);
  }

 private:
  // World to lobe: the lobe is turned about z, then leans over to +x.
  Vec3 Local(const Vec3& w) const { return RotateZ(RotateY(w, -tilt), -rotation); }
  double Lambda(const Vec3& w) const {
    const double t = (alpha_x * w.x * alpha_x * w.x + alpha_y * w.y * alpha_y * w.y) / (w.z * w.z);
    return (std::sqrt(1 + t) - 1) / 2;
  }
};

}  // namespace lobefit
