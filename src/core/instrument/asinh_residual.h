// Residuals of readings whose noise has a floor and a relative part, s(v)^2 = s0^2 + (rho v)^2, v = f_r cos_theta_i in
// 1/sr: the transform that stabilises it, and the weights that stabilise the others.
//
// T(v) = asinh(v / knee), knee = s0 / rho, has T' = rho / s(v): a reading's standard deviation in it is rho everywhere.
// Linear below the knee, a logarithm above, odd, so that no negative reading is set aside. Its mean is off by -(rho /
// 2) (rho v / s) standard deviations, which the corrected form takes away to second order.
#pragma once

#include <cmath>

namespace lobefit {

// s0 > 0 in 1/sr, rho > 0 without unit.
template <class T>
struct NoiseModelT {
  T floor, relative;
  T knee() const { return floor / relative; }
  // s(v).
  T Deviation(const T& v) const {
    using std::sqrt;
    return sqrt(floor * floor + relative * relative * v * v);
  }
};
using NoiseModel = NoiseModelT<double>;

template <class T>
struct AsinhResidual {
  T of_model, of_measured;     // T(v), T(m)
  T residual, dresidual_dv;    // T(v) - T(m)
  T corrected, dcorrected_dv;  // T(v) - (rho^2 / 2) v / sqrt(v^2 + knee^2) - T(m)
  T dresidual_dm;              // of both
};

template <class T>
AsinhResidual<T> EvaluateAsinhResidual(const NoiseModelT<T>& noise, const T& model, const T& measured) {
  using std::asinh;
  using std::sqrt;
  const T knee = noise.knee(), length = sqrt(model * model + knee * knee);
  const T half_square = noise.relative * noise.relative / T(2);
  AsinhResidual<T> r;
  r.of_model = asinh(model / knee);
  r.of_measured = asinh(measured / knee);
  r.residual = r.of_model - r.of_measured;
  r.dresidual_dv = T(1) / length;
  r.corrected = r.residual - half_square * model / length;
  r.dcorrected_dv = r.dresidual_dv - half_square * (knee / length) * (knee / length) / length;
  r.dresidual_dm = T(-1) / sqrt(measured * measured + knee * knee);
  return r;
}

// Weights 1 / (T'(v) s(v))^2 of a squared residual at the model's value v >= 0, by the metric's transform. From the
// reading instead they would favour readings that fell low.
template <class T>
struct MetricWeights {
  T log;        // T = ln(1 + v)
  T cube_root;  // T = v^(1/3)
  T relative;   // residual (v - m) / v
  T cosine_l2;  // T = v
};

template <class T>
MetricWeights<T> WeightsAt(const NoiseModelT<T>& noise, const T& v) {
  using std::cbrt;
  const T s = noise.Deviation(v), root = cbrt(v);
  const T of_log = (T(1) + v) / s, of_root = T(3) * root * root / s, of_ratio = v / s;
  return {of_log * of_log, of_root * of_root, of_ratio * of_ratio, T(1) / (s * s)};
}

}  // namespace lobefit
