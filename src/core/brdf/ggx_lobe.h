// GGX lobes for arrays of samples, in SIMD with run-time dispatch, and the same for one sample: the specular factor of
// the BRDF, D and G1, each with its gradient.
#pragma once

#include <cstddef>

#include "lobefit/core/brdf/model.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// Directions of `count` samples, structure of arrays; unit vectors with z > 0.
struct DirectionArrays {
  const double* wi_x;
  const double* wi_y;
  const double* wi_z;
  const double* wo_x;
  const double* wo_y;
  const double* wo_z;
  std::size_t count;
};

// specular[i] = D(wh) G2(wi, wo) / (4 cos_theta_i cos_theta_o), 1/sr; cos_d[i] = wi . wh.
// The lobe is given in slope coordinates (off_center.h), in which it is fitted; any finite values are valid. `masking`
// is one of the first three kinds; lobe.h evaluates all. gradient: 5 arrays of `count`, one after the other, d specular
// / d v[j]; null = not wanted. The value is the same either way. Where a clamped G1 is at 1, its derivative is 0: the
// model has a kink there. Formulas: [Walter eq 1, 4-6], [Heitz eq 99], in slope space (MATH.md sections 6 and 7); see
// ggx_lobe-inl.h.
void GgxLobe(const DirectionArrays& directions, const SlopeCoordinates& shape, Masking masking, double* specular,
             double* cos_d, double* gradient);

// One sample, by the same operations in the same order: the same bits.
double GgxLobe(const Vec3& wi, const Vec3& wo, const SlopeCoordinates& shape, Masking masking, double* cos_d,
               double gradient[5]);

// One vector a sample, structure of arrays.
struct VectorArrays {
  const double* x;
  const double* y;
  const double* z;
  std::size_t count;
};

// The factors alone. D(wm), 1/sr, for unit wm, 0 below the horizon [Walter eq 1]; G1(u) = u_z / sigma(u) for u_z > 0,
// at most 1 if `clamp` [Walter eq 6]. Gradient as above; the functions of one sample give the same bits.
void GgxD(const VectorArrays& wm, const SlopeCoordinates& shape, double* D, double* gradient);
double GgxD(const Vec3& wm, const SlopeCoordinates& shape, double gradient[5]);
void GgxG1(const VectorArrays& u, const SlopeCoordinates& shape, bool clamp, double* G1, double* gradient);
double GgxG1(const Vec3& u, const SlopeCoordinates& shape, bool clamp, double gradient[5]);

}  // namespace lobefit
