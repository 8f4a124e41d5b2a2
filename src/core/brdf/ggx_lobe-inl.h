// The specular factor of a GGX lobe in slope space, with its gradient, written once for a scalar and for SIMD vectors:
// V is double or a vector of the SIMD library. The operations and their order are the same, and the files that include
// this are compiled without contraction to FMA, so that every instruction set gives the same bits.
//
// D: off-centre, correlated GGX [Heitz eq 84-95, Loubet sec 2] = ellipsoid NDF [Walter eq 1] (MATH.md section 6):
//   h = wi + wo (not normalised), g = (-h_x - x_s h_z, -h_y - y_s h_z), y = L^-1 g, K = h_z^2 + |y|^2, D = |h|^4 / (pi
//   a c K^2)
// G1 [Walter eq 6 = Loubet eq 1]: cos / sigma, sigma = (c_u + s) / 2, s = sqrt(c_u^2 + q), c_u = u_z - x_s u_x - y_s
// u_y, q = |L^T u_xy|^2;
//   for c_u < 0, where c_u + s cancels: sigma = q / (2 (s - c_u)).
// Gradient of the logarithms, with z = L^-T y:
//   d ln D / d(x_s, y_s, ln a, b, ln c) = (4 z_1 h_z, 4 z_2 h_z, 4 a z_1 y_1 - K, 4 z_2 y_1, 4 c z_2 y_2 - K) / K
//   d ln sigma / d(...) = (-u_x, -u_y, (a u_x + b u_y) a u_x / (2 sigma), (a u_x + b u_y) u_y / (2 sigma), c^2 u_y^2 /
//   (2 sigma)) / s
// No include guard: included once for each target.

// Uniform over a block of samples.
template <class V>
struct GgxLobeUniform {
  V slope_x, slope_y, a, b, c, inv_a, inv_c, quarter_inv_pi_det;
};

// sigma(u) = over / under, without the division: the callers fold it into one of their own.
template <class V>
struct GgxSigma {
  V over, under, s, q1, q2;
};

template <class V>
HWY_INLINE GgxSigma<V> EvaluateSigma(const GgxLobeUniform<V>& p, V ux, V uy, V uz) {
  const V cu = uz - p.slope_x * ux - p.slope_y * uy;
  const V q1 = p.a * ux + p.b * uy;
  const V q2 = p.c * uy;
  const V q = q1 * q1 + q2 * q2;
  const V s = Root(cu * cu + q);
  const V t = SelectNegative(cu, s - cu, s + cu);
  return {SelectNegative(cu, q, t), SelectNegative(cu, t + t, Constant(cu, 2.0)), s, q1, q2};
}

// Adds factor * d ln sigma / d(slope coordinates) to gradient[5]; inverse = 1 / (s over).
template <class V>
HWY_INLINE void AddGradientLogSigma(const GgxLobeUniform<V>& p, V ux, V uy, const GgxSigma<V>& sigma, V inverse,
                                    V factor, V* gradient) {
  const V f = factor * inverse * sigma.over;
  const V g = Constant(f, 0.5) * factor * inverse * sigma.under;
  const V q1g = sigma.q1 * g;
  gradient[0] = gradient[0] - f * ux;
  gradient[1] = gradient[1] - f * uy;
  gradient[2] = gradient[2] + q1g * p.a * ux;
  gradient[3] = gradient[3] + q1g * uy;
  gradient[4] = gradient[4] + sigma.q2 * sigma.q2 * g;
}

// D(wm) for unit wm, 0 below the horizon; with kGradient also dD / d(slope coordinates).
template <bool kGradient, class V>
HWY_INLINE V GgxDistribution(const GgxLobeUniform<V>& p, V mx, V my, V mz, V* gradient) {
  const V zero = Constant(mz, 0.0), one = Constant(mz, 1.0), four = Constant(mz, 4.0);
  const V y1 = (zero - mx - p.slope_x * mz) * p.inv_a;
  const V y2 = (zero - my - p.slope_y * mz - p.b * y1) * p.inv_c;
  const V k = mz * mz + y1 * y1 + y2 * y2;
  const V value = SelectNegative(mz, zero, four * p.quarter_inv_pi_det / (k * k));
  if constexpr (kGradient) {
    const V z2 = y2 * p.inv_c;
    const V z1 = (y1 - p.b * z2) * p.inv_a;
    const V f = four / k;
    gradient[0] = value * (f * z1 * mz);
    gradient[1] = value * (f * z2 * mz);
    gradient[2] = value * (f * p.a * z1 * y1 - one);
    gradient[3] = value * (f * z2 * y1);
    gradient[4] = value * (f * p.c * z2 * y2 - one);
  }
  return value;
}

// G1(u) for u_z > 0, at most 1 if kClamp; with kGradient also dG1 / d(slope coordinates), 0 where clamped.
template <bool kGradient, bool kClamp, class V>
HWY_INLINE V GgxMaskingG1(const GgxLobeUniform<V>& p, V ux, V uy, V uz, V* gradient) {
  const GgxSigma<V> sigma = EvaluateSigma(p, ux, uy, uz);
  const V scaled = uz * sigma.under;
  const V quotient = scaled / sigma.over;
  const V value = kClamp ? SelectNegative(sigma.over - scaled, Constant(uz, 1.0), quotient) : quotient;
  if constexpr (kGradient) {
    const V zero = Constant(uz, 0.0);
    V factor = zero - value;
    if constexpr (kClamp) factor = SelectNegative(sigma.over - scaled, zero, factor);
    for (int j = 0; j < 5; ++j) gradient[j] = zero;
    AddGradientLogSigma(p, ux, uy, sigma, Constant(uz, 1.0) / (sigma.s * sigma.over), factor, gradient);
  }
  return value;
}

// specular = D G2 / (4 cos_theta_i cos_theta_o) in 1/sr; cos_d = wi . wh. With kGradient also d specular / d(slope
// coordinates).
template <bool kGradient, Masking kMasking, class V>
HWY_INLINE V GgxSpecular(const GgxLobeUniform<V>& p, V ix, V iy, V iz, V ox, V oy, V oz, V* cos_d, V* gradient) {
  const V hx = ix + ox, hy = iy + oy, hz = iz + oz;
  const V h2 = hx * hx + hy * hy + hz * hz;
  *cos_d = Constant(h2, 0.5) * Root(h2);
  const V zero = Constant(h2, 0.0), one = Constant(h2, 1.0);
  const V y1 = (zero - hx - p.slope_x * hz) * p.inv_a;
  const V y2 = (zero - hy - p.slope_y * hz - p.b * y1) * p.inv_c;
  const V k = hz * hz + y1 * y1 + y2 * y2;
  const GgxSigma<V> i = EvaluateSigma(p, ix, iy, iz), o = EvaluateSigma(p, ox, oy, oz);
  // X = over / under, X = max(sigma, cos) where clamped.
  V over_i = i.over, under_i = i.under, over_o = o.over, under_o = o.under;
  if constexpr (kMasking != Masking::kSmithUnclamped) {
    const V excess_i = i.over - iz * i.under, excess_o = o.over - oz * o.under;
    over_i = SelectNegative(excess_i, iz, i.over);
    under_i = SelectNegative(excess_i, one, i.under);
    over_o = SelectNegative(excess_o, oz, o.over);
    under_o = SelectNegative(excess_o, one, o.under);
  }
  // 1 / G2 times the cosines and both `under`. Separable: X_i X_o; height-correlated: X_i o_z + X_o i_z - i_z o_z,
  // written without cancellation.
  V both = over_i * over_o;
  if constexpr (kMasking == Masking::kSmithHeight) {
    both = over_i * under_o * oz + (over_o - oz * under_o) * under_i * iz;
  }
  // The only division of the value.
  const V inverse = one / (k * k * both);
  const V specular = p.quarter_inv_pi_det * (h2 * h2) * (under_i * under_o) * inverse;
  if constexpr (kGradient) {
    const V z2 = y2 * p.inv_c;
    const V z1 = (y1 - p.b * z2) * p.inv_a;
    const V f = Constant(h2, 4.0) * inverse * k * both;  // 4 / k
    gradient[0] = f * z1 * hz;
    gradient[1] = f * z2 * hz;
    gradient[2] = f * p.a * z1 * y1 - one;
    gradient[3] = f * z2 * y1;
    gradient[4] = f * p.c * z2 * y2 - one;
    // -d ln both = -(d ln X) times this factor; a clamped X does not move.
    V factor_i = zero - one, factor_o = zero - one;
    if constexpr (kMasking == Masking::kSmithHeight) {
      const V inverse_both = inverse * k * k;
      factor_i = factor_i * over_i * under_o * oz * inverse_both;
      factor_o = factor_o * over_o * under_i * iz * inverse_both;
    }
    if constexpr (kMasking != Masking::kSmithUnclamped) {
      factor_i = SelectNegative(i.over - iz * i.under, zero, factor_i);
      factor_o = SelectNegative(o.over - oz * o.under, zero, factor_o);
    }
    // One division for the two inverses 1 / (s over).
    const V product_i = i.s * i.over, product_o = o.s * o.over;
    const V inverse_products = one / (product_i * product_o);
    AddGradientLogSigma(p, ix, iy, i, inverse_products * product_o, factor_i, gradient);
    AddGradientLogSigma(p, ox, oy, o, inverse_products * product_i, factor_o, gradient);
    for (int j = 0; j < 5; ++j) gradient[j] = gradient[j] * specular;
  }
  return specular;
}
