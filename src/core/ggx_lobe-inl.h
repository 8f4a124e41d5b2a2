// The specular factor of a GGX lobe in slope space, with its gradient, written once for a scalar and for SIMD vectors: V is double or
// a vector of the SIMD library. The operations and their order are the same, and the files that include this are
// compiled without contraction to FMA, so that every instruction set gives the same bits.
//
// D: off-centre, correlated GGX [Heitz eq 84-95, Loubet sec 2] = ellipsoid NDF [Walter eq 1] (math.md section 6):
//   h = wi + wo (not normalised), g = (-h_x - x_s h_z, -h_y - y_s h_z), y = L^-1 g, K = h_z^2 + |y|^2, D = |h|^4 / (pi a c K^2)
// G1 [Walter eq 6 = Loubet eq 1]: cos / sigma, sigma = (c_u + s) / 2, s = sqrt(c_u^2 + q), c_u = u_z - x_s u_x - y_s u_y, q = |L^T u_xy|^2;
//   for c_u < 0, where c_u + s cancels: sigma = q / (2 (s - c_u)).
// Gradient of the logarithms, with z = L^-T y:
//   d ln D / d(x_s, y_s, ln a, b, ln c) = (4 z_1 h_z, 4 z_2 h_z, 4 a z_1 y_1 - K, 4 z_2 y_1, 4 c z_2 y_2 - K) / K
//   d ln sigma / d(...) = (-u_x, -u_y, (a u_x + b u_y) a u_x / (2 sigma), (a u_x + b u_y) u_y / (2 sigma), c^2 u_y^2 / (2 sigma)) / s
// No include guard: included once for each target.

// Uniform over a block of samples.
template <class V>
struct GgxLobeUniform {
  V slope_x, slope_y, a, b, c, inv_a, inv_c, quarter_inv_pi_det;
};

// sigma(u), and s where `s` is wanted too.
template <class V>
HWY_INLINE V GgxSigma(const GgxLobeUniform<V>& p, V ux, V uy, V uz, V* s) {
  const V cu = uz - p.slope_x * ux - p.slope_y * uy;
  const V q1 = p.a * ux + p.b * uy;
  const V q2 = p.c * uy;
  const V q = q1 * q1 + q2 * q2;
  *s = Root(cu * cu + q);
  const V half = Constant(cu, 0.5);
  return SelectNegative(cu, half * q / (*s - cu), half * (cu + *s));
}

// Adds factor * d ln sigma / d(slope coordinates) to gradient[5].
template <class V>
HWY_INLINE void AddGradientLogSigma(const GgxLobeUniform<V>& p, V ux, V uy, V sigma, V s, V factor, V* gradient) {
  const V f = factor / s;
  const V g = Constant(f, 0.5) * f / sigma;
  const V q1g = (p.a * ux + p.b * uy) * g;
  const V q2 = p.c * uy;
  gradient[0] = gradient[0] - f * ux;
  gradient[1] = gradient[1] - f * uy;
  gradient[2] = gradient[2] + q1g * p.a * ux;
  gradient[3] = gradient[3] + q1g * uy;
  gradient[4] = gradient[4] + q2 * q2 * g;
}

enum class GgxMasking { kClamped, kUnclamped, kHeight };

// specular = D G2 / (4 cos_theta_i cos_theta_o) in 1/sr; cos_d = wi . wh. With kGradient also d specular / d(slope coordinates).
template <bool kGradient, GgxMasking kMasking, class V>
HWY_INLINE V GgxSpecular(const GgxLobeUniform<V>& p, V ix, V iy, V iz, V ox, V oy, V oz, V* cos_d, V* gradient) {
  const V hx = ix + ox, hy = iy + oy, hz = iz + oz;
  const V h2 = hx * hx + hy * hy + hz * hz;
  *cos_d = Constant(h2, 0.5) * Root(h2);
  const V zero = Constant(h2, 0.0), one = Constant(h2, 1.0);
  const V y1 = (zero - hx - p.slope_x * hz) * p.inv_a;
  const V y2 = (zero - hy - p.slope_y * hz - p.b * y1) * p.inv_c;
  const V k = hz * hz + y1 * y1 + y2 * y2;
  const V ratio = h2 / k;
  const V d_over_4 = p.quarter_inv_pi_det * ratio * ratio;
  V si, so;
  const V sigma_i = GgxSigma(p, ix, iy, iz, &si);
  const V sigma_o = GgxSigma(p, ox, oy, oz, &so);
  const V xi = kMasking == GgxMasking::kUnclamped ? sigma_i : Larger(sigma_i, iz);
  const V xo = kMasking == GgxMasking::kUnclamped ? sigma_o : Larger(sigma_o, oz);
  // Separable: 1 / (X_i X_o). Height-correlated: 1 / (X_i o_z + X_o i_z - i_z o_z), written without cancellation.
  const V both = kMasking == GgxMasking::kHeight ? xi * oz + (xo - oz) * iz : xi * xo;
  const V specular = d_over_4 / both;
  if constexpr (kGradient) {
    const V z2 = y2 * p.inv_c;
    const V z1 = (y1 - p.b * z2) * p.inv_a;
    const V f = Constant(h2, 4.0) / k;
    gradient[0] = f * z1 * hz;
    gradient[1] = f * z2 * hz;
    gradient[2] = f * p.a * z1 * y1 - one;
    gradient[3] = f * z2 * y1;
    gradient[4] = f * p.c * z2 * y2 - one;
    // -d ln both = -(d ln X) times this factor; a clamped X does not move.
    V factor_i = zero - one, factor_o = zero - one;
    if constexpr (kMasking == GgxMasking::kHeight) {
      factor_i = factor_i * xi * oz / both;
      factor_o = factor_o * xo * iz / both;
    }
    if constexpr (kMasking != GgxMasking::kUnclamped) {
      factor_i = SelectNegative(sigma_i - iz, zero, factor_i);
      factor_o = SelectNegative(sigma_o - oz, zero, factor_o);
    }
    AddGradientLogSigma(p, ix, iy, sigma_i, si, factor_i, gradient);
    AddGradientLogSigma(p, ox, oy, sigma_o, so, factor_o, gradient);
    for (int j = 0; j < 5; ++j) gradient[j] = gradient[j] * specular;
  }
  return specular;
}
