// A sample that does not lie as the instrument believes: turned by R = Rz(e_z) Ry(e_y) Rx(e_x).
//
// Directions in its own frame are w' = R^T w = Rx(-e_x) Ry(-e_y) Rz(-e_z) w, and d w' / d e_k = -a_k x w' with a_x = x,
// a_y = Rx(-e_x) y, a_z = Rx(-e_x) Ry(-e_y) z.
#pragma once

#include <array>
#include <cmath>

#include "lobefit/core/microfacet/ellipsoid_brdf.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// Radians.
template <class T>
struct MisalignmentT {
  T e_x, e_y, e_z;
};
using Misalignment = MisalignmentT<double>;

template <class T>
Vec3T<T> InSampleFrame(const MisalignmentT<T>& e, const Vec3T<T>& w) {
  using std::cos;
  using std::sin;
  const T cx = cos(e.e_x), sx = sin(e.e_x), cy = cos(e.e_y), sy = sin(e.e_y), cz = cos(e.e_z), sz = sin(e.e_z);
  const Vec3T<T> z = {cz * w.x + sz * w.y, cz * w.y - sz * w.x, w.z};
  const Vec3T<T> y = {cy * z.x - sy * z.z, z.y, cy * z.z + sy * z.x};
  return {y.x, cx * y.y + sx * y.z, cx * y.z - sx * y.y};
}

// a_x, a_y, a_z.
std::array<Vec3, 3> MisalignmentAxes(const Misalignment& e);

// What the instrument reports of f_r' = f_r(wi', wo').
enum class ValueKind {
  kBrdf,      // f_r'
  kRadiance,  // f_r' cos_i' / cos_i: radiance over the nominal irradiance
  kFlux,      // f_r' cos_o' / cos_o: flux over the nominal cosine
};

// The value of `kind` for the ellipsoid with a conductor's Fresnel factor; 0 where a turned direction is at or below
// the sample's horizon. wi, wo above the nominal horizon. gradient: e_x, e_y, e_z, alpha_x, alpha_y, theta_x, theta_y,
// theta_z; null skips it.
double MisalignedConductorBrdf(const Ellipsoid& ellipsoid, const ConductorIndex& index, const Vec3& wo, const Vec3& wi,
                               const Misalignment& misalignment, ValueKind kind, double gradient[8],
                               BrdfFactors* factors = nullptr);

}  // namespace lobefit
