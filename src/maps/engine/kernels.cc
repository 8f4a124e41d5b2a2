#include "lobefit/maps/engine/kernels.h"

#include <cmath>
#include <cstring>

// clang has no such functions for C++ yet: it takes the plain one.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define LOBEFIT_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define LOBEFIT_CLONES
#endif

namespace lobefit {

namespace {

// Four lanes, on any instruction set.
using Lanes = double __attribute__((vector_size(32)));
static_assert(sizeof(Lanes) == LightArrays::kLanes * sizeof(double));

}  // namespace

LOBEFIT_CLONES
void DotProducts(const double* a, const double* const* b, int count, std::size_t padded, double* out) {
  for (int k = 0; k < count; k += 4) {
    // The last block takes its own last array again where fewer than four are left.
    const double* with[4];
    for (int i = 0; i < 4; ++i) with[i] = b[k + i < count ? k + i : count - 1];
    Lanes s0 = {}, s1 = {}, s2 = {}, s3 = {};
    for (std::size_t l = 0; l < padded; l += LightArrays::kLanes) {
      Lanes x, y;
      std::memcpy(&x, a + l, sizeof x);
      std::memcpy(&y, with[0] + l, sizeof y);
      s0 += x * y;
      std::memcpy(&y, with[1] + l, sizeof y);
      s1 += x * y;
      std::memcpy(&y, with[2] + l, sizeof y);
      s2 += x * y;
      std::memcpy(&y, with[3] + l, sizeof y);
      s3 += x * y;
    }
    const double sums[4] = {(s0[0] + s0[1]) + (s0[2] + s0[3]), (s1[0] + s1[1]) + (s1[2] + s1[3]),
                            (s2[0] + s2[1]) + (s2[2] + s2[3]), (s3[0] + s3[1]) + (s3[2] + s3[3])};
    for (int i = 0; i < 4 && k + i < count; ++i) out[k + i] = sums[i];
  }
}

LOBEFIT_CLONES
void Multiply(const double* __restrict a, const double* __restrict b, std::size_t padded, double* __restrict out) {
  for (std::size_t l = 0; l < padded; ++l) out[l] = a[l] * b[l];
}

LOBEFIT_CLONES
void AddResiduals(const Amplitudes& amplitudes, const double* __restrict cosine, const double* __restrict specular,
                  const double* __restrict k, const double* __restrict live, const double* __restrict values,
                  std::size_t padded, double* __restrict residual, double* __restrict square) {
  const double d = amplitudes.diffuse, f = amplitudes.f0, rest = amplitudes.carried - amplitudes.f0;
  for (std::size_t l = 0; l < padded; ++l) {
    const double r = live[l] * (d * cosine[l] + (f + rest * k[l]) * specular[l] - values[l]);
    residual[l] = r;
    square[l] += r * r;
  }
}

LOBEFIT_CLONES
void AddColumn(const Amplitudes& amplitudes, const double* __restrict dcosine, const double* __restrict dspecular,
               const double* __restrict k, const double* __restrict residual, std::size_t padded,
               double* __restrict column, double* __restrict row) {
  const double d = amplitudes.diffuse, f = amplitudes.f0, rest = amplitudes.carried - amplitudes.f0;
  for (std::size_t l = 0; l < padded; ++l) {
    const double value = d * dcosine[l] + (f + rest * k[l]) * dspecular[l];
    column[l] = value;
    row[l] += residual[l] * value;
  }
}

namespace {

LOBEFIT_CLONES
void IsotropicValue(double alpha, const Vec3& n, const LightArrays& lights, const double* __restrict cosine,
                    double* __restrict specular) {
  const double a2 = alpha * alpha, inverse = 1 / a2;
  const double so = std::sqrt(n.z * n.z + a2 * (1 - n.z * n.z)), factor = kInvPi * inverse / (n.z + so);
  const double *hx = lights.h_x.data(), *hy = lights.h_y.data(), *h_z = lights.h_z.data(), *sq = lights.square.data();
  for (std::size_t l = 0; l < lights.padded; ++l) {
    const double c = cosine[l], hz = n.x * hx[l] + n.y * hy[l] + n.z * h_z[l];
    const double K = hz * hz + (sq[l] - hz * hz) * inverse, s = std::sqrt(c * c + a2 * (1 - c * c));
    specular[l] = factor * sq[l] * sq[l] / (K * K * (c + s)) * c;
  }
}

LOBEFIT_CLONES
void IsotropicGradient(double alpha, const MapFrame& f, const LightArrays& lights, const double* __restrict cosine,
                       double* __restrict specular, double* __restrict by_t, double* __restrict by_b,
                       double* __restrict by_alpha) {
  const Vec3 &n = f.n, &t = f.t, &b = f.b;
  const double a2 = alpha * alpha, inverse = 1 / a2;
  const double co = n.z, so = std::sqrt(co * co + a2 * (1 - co * co)), factor = kInvPi * inverse / (co + so);
  const double dlog_co = -(1 + co * (1 - a2) / so) / (co + so);
  const double dlog_alpha = -2 - a2 * (1 - co * co) / (so * (co + so));
  const double *x = lights.x.data(), *y = lights.y.data(), *z = lights.z.data();
  const double *hx = lights.h_x.data(), *hy = lights.h_y.data(), *h_z = lights.h_z.data(), *sq = lights.square.data();
  for (std::size_t l = 0; l < lights.padded; ++l) {
    const double c = cosine[l], hz = n.x * hx[l] + n.y * hy[l] + n.z * h_z[l], off = sq[l] - hz * hz;
    const double K = hz * hz + off * inverse, s = std::sqrt(c * c + a2 * (1 - c * c));
    const double per_c = factor * sq[l] * sq[l] / (K * K * (c + s)), value = per_c * c;
    specular[l] = value;
    // d ln specular by h_z, i_z and ln alpha, times specular; 1 / i_z is multiplied out: it may be 0.
    const double over_K = 2 * value / K, over_c = value / (c + s);
    const double by_hz = -over_K * 2 * hz * (1 - inverse), by_co = value * dlog_co;
    const double by_ci = per_c - over_c * (1 + c * (1 - a2) / s);
    by_alpha[l] = value * dlog_alpha + over_K * 2 * off * inverse - over_c * a2 * (1 - c * c) / s;
    const double lit = c > 0 ? 1.0 : 0.0;
    by_t[l] = lit * (by_hz * (t.x * hx[l] + t.y * hy[l] + t.z * h_z[l]) +
                     by_ci * (t.x * x[l] + t.y * y[l] + t.z * z[l]) + by_co * t.z);
    by_b[l] = lit * (by_hz * (b.x * hx[l] + b.y * hy[l] + b.z * h_z[l]) +
                     by_ci * (b.x * x[l] + b.y * y[l] + b.z * z[l]) + by_co * b.z);
  }
}

}  // namespace

void IsotropicLobe(double alpha, const MapFrame& frame, const LightArrays& lights, const IsotropicArrays& arrays) {
  if (arrays.dspecular == nullptr) {
    IsotropicValue(alpha, frame.n, lights, arrays.cosine, arrays.specular);
  } else {
    IsotropicGradient(alpha, frame, lights, arrays.cosine, arrays.specular, arrays.dspecular[0], arrays.dspecular[1],
                      arrays.dspecular[2]);
  }
}

}  // namespace lobefit
