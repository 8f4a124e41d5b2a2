// The curves T of the metrics on arrays of samples, in SIMD with run-time dispatch: value, difference, derivatives,
// delta-method weight. v = f cos_theta_i.
//
// Right to rounding for |v| from 1e-308 to 1e308 (kAsinh: |v| / knee); NaN stays NaN, infinity stays infinity where the
// curve has no limit.
#pragma once

#include <cstddef>

namespace lobefit {

enum class Curve {
  kLogOnePlus,  // ln(1 + v), v > -1
  kCubeRoot,    // v^(1/3), odd
  kLinear,      // v
  kRelative,    // f / m for a measured m > 0
  // asinh(v / knee), odd: linear below the knee, logarithmic above. For noise of standard deviation sqrt(s0^2 + (rho
  // v)^2) and the knee s0 / rho its noise is rho at every v, but a mean of -(rho^2 / 2) v / sqrt(v^2 + knee^2), which
  // `mean_shift` = rho^2 / 2 takes out of the difference (second order of the delta method). Of noise of another
  // variance the mean is -(v / 2) variance / (v^2 + knee^2)^(3/2); with `floor_shift` = (s0^2 - (rho knee)^2) / 2 and
  // `poisson_shift` = c / 2 that of s0^2 + c |v| + (rho v)^2 is taken out.
  kAsinh,
};

struct Transform {
  Curve curve = Curve::kLogOnePlus;
  double knee = 1;                                            // kAsinh only
  double mean_shift = 0, floor_shift = 0, poisson_shift = 0;  // kAsinh only
};

// Whether the curve has a number for a measured f_r.
inline bool Takes(const Transform& transform, double f_r, double cos_theta_i) {
  if (transform.curve == Curve::kLogOnePlus) return f_r * cos_theta_i > -1;
  return transform.curve != Curve::kRelative || f_r > 0;
}

// All arrays have `count` entries.

// residual = sqrt_weight (T(f) - T(measured)) without cancellation, slope = sqrt_weight dT/df. Null: sqrt_weight 1,
// slope not wanted. Where the model vanishes the cube root's slope is infinite: it is taken at a millionth of the
// measured value, or at v = 1e-45, at least.
void Residuals(const Transform& transform, const double* f, const double* cos_i, const double* measured,
               const double* sqrt_weight, std::size_t count, double* residual, double* slope);

// T of measured values; kRelative: f_r itself.
void ApplyTransform(const Transform& transform, const double* f_r, const double* cos_i, std::size_t count,
                    double* values);

// 1 / T'(v) at v = f cos_theta_i, so that 1 / (T'(v) s)^2, the delta method's weight of a residual whose reading has
// the standard deviation s, is (to / s)^2.
void InverseSlopes(const Transform& transform, const double* f, const double* cos_i, std::size_t count, double* to);

// T''(v) as it acts on the mean of a residual times its slope over the slope at v: noise of standard deviation s about
// v moves T(measured) by T''(v) s^2 / 2. Of kAsinh what mean_shift leaves, 0.
void Curvatures(const Transform& transform, const double* f, const double* cos_i, std::size_t count, double* to);

}  // namespace lobefit
