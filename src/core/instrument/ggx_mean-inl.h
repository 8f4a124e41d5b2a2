// Means of a GGX lobe over the discs of source and detector, with their gradients, written once for a scalar and for
// SIMD vectors; to be included after ggx_lobe-inl.h, whose rules hold here. The file that includes this also gives
// bool AnyNegative(V).
//
// The half vectors of a disc about wo (or wi: the same set) are a quadratic cone, h^T C h <= 0 with eigenvectors h, e2,
// e3 of the pair (aperture.h) and eigenvalues -tau, 2 - tau, kappa = h2 - tau. The map u -> w = (y(u), u_z) with y =
// L^-1 (-u_xy - mean u_z) turns the lobe into a cosine lobe about n and the cone into an elliptic cone, whose vector
// irradiance lies on its axis v and is pi F. So, exactly, with b_k = w(h), w(e2), w(e3):
//   P = b3 b3^T / kappa + b2 b2^T / (2 - tau) - b1 b1^T / tau has one negative eigenvalue nu, of v,
//   F = sqrt(det P / (nu p'(nu))), det P = -1 / (tau kappa (2 - tau) (a c)^2), p the characteristic polynomial,
//   < D > = 2 F (v . A f) / (pi tau),  A f = (-L^T f_xy, f_z - mean . f_xy),
// f = wi for the detector's disc, wo for the source's, weighted by the shares for both. Newton from -|b1|^2 / tau rises
// to nu monotonically. Gradient: the map changes by dw = d e_c . w for each coordinate, so that dP = d m^T + m d^T, m
// the c-th column of P; no division by a difference of eigenvalues, isotropic lobes are not special.

template <class V>
struct GgxVector {
  V x, y, z;
};

template <class V>
HWY_INLINE V DotOf(const GgxVector<V>& a, const GgxVector<V>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
HWY_INLINE GgxVector<V> CrossOf(const GgxVector<V>& a, const GgxVector<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class V>
HWY_INLINE GgxVector<V> Times(V s, const GgxVector<V>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

// Axes of a pair as in aperture.h, FrameOf.
template <class V>
struct GgxPairFrame {
  GgxVector<V> h, e2, e3;
  V h2;
};

template <class V>
HWY_INLINE GgxPairFrame<V> FrameOfPair(const GgxVector<V>& i, const GgxVector<V>& o) {
  const V zero = Constant(i.x, 0.0), one = Constant(i.x, 1.0);
  GgxPairFrame<V> f;
  const GgxVector<V> sum = {i.x + o.x, i.y + o.y, i.z + o.z};
  const V length2 = DotOf(sum, sum);
  f.h2 = Constant(i.x, 0.5) * length2;
  f.h = Times(one / Root(length2), sum);
  GgxVector<V> along = {i.x - o.x, i.y - o.y, i.z - o.z};
  const V same = DotOf(along, along) - Constant(i.x, 1e-12);
  // Across h: h x (1, 0, 0) or h x (0, 1, 0).
  const V steep = f.h.x * f.h.x - Constant(i.x, 0.49);
  along.x = SelectNegative(same, SelectNegative(steep, zero, zero - f.h.z), along.x);
  along.y = SelectNegative(same, SelectNegative(steep, f.h.z, zero), along.y);
  along.z = SelectNegative(same, SelectNegative(steep, zero - f.h.y, f.h.x), along.z);
  const V parallel = DotOf(f.h, along);
  along = {along.x - parallel * f.h.x, along.y - parallel * f.h.y, along.z - parallel * f.h.z};
  f.e2 = Times(one / Root(DotOf(along, along)), along);
  f.e3 = CrossOf(f.h, f.e2);
  return f;
}

// w(u), see above.
template <class V>
HWY_INLINE GgxVector<V> InLobe(const GgxLobeUniform<V>& p, const GgxVector<V>& u) {
  const V zero = Constant(u.x, 0.0);
  const V y1 = (zero - u.x - p.slope_x * u.z) * p.inv_a;
  return {y1, (zero - u.y - p.slope_y * u.z - p.b * y1) * p.inv_c, u.z};
}

// The axis v of the image of a cone and what its mean needs: the eigenvalue nu, p'(nu), the trace, and P row by row.
template <class V>
struct GgxConeAxis {
  GgxVector<V> v;
  V nu, slope, trace;
  GgxVector<V> row[3];
};

template <class V>
HWY_INLINE GgxConeAxis<V> ConeAxis(const GgxVector<V>& b1, const GgxVector<V>& b2, const GgxVector<V>& b3, V w1, V w2,
                                   V w3, V det) {
  const V zero = Constant(w1, 0.0), one = Constant(w1, 1.0), two = Constant(w1, 2.0), three = Constant(w1, 3.0);
  GgxConeAxis<V> c;
  const V xx = w3 * b3.x * b3.x + w2 * b2.x * b2.x - w1 * b1.x * b1.x;
  const V xy = w3 * b3.x * b3.y + w2 * b2.x * b2.y - w1 * b1.x * b1.y;
  const V xz = w3 * b3.x * b3.z + w2 * b2.x * b2.z - w1 * b1.x * b1.z;
  const V yy = w3 * b3.y * b3.y + w2 * b2.y * b2.y - w1 * b1.y * b1.y;
  const V yz = w3 * b3.y * b3.z + w2 * b2.y * b2.z - w1 * b1.y * b1.z;
  const V zz = w3 * b3.z * b3.z + w2 * b2.z * b2.z - w1 * b1.z * b1.z;
  const V a = xx + yy + zz;
  const V b = (xx * yy - xy * xy) + (xx * zz - xz * xz) + (yy * zz - yz * yz);
  V nu = zero - w1 * DotOf(b1, b1);
  V active = zero - one;
  for (int step = 0; step < 24; ++step) {
    const V value = ((nu - a) * nu + b) * nu - det;
    const V rise = value / ((three * nu - two * a) * nu + b);
    nu = SelectNegative(active, nu - rise, nu);
    // Converged where the step is below 1e-14: the next would be below rounding. A lane that has converged rests, so
    // that its bits do not depend on its neighbours.
    active = SelectNegative(Constant(nu, 1e-28) * nu * nu - rise * rise, active, one);
    if (!AnyNegative(active)) break;
  }
  c.nu = nu;
  c.slope = (three * nu - two * a) * nu + b;
  c.trace = a;
  c.row[0] = {xx, xy, xz};
  c.row[1] = {xy, yy, yz};
  c.row[2] = {xz, yz, zz};
  // adj(P - nu) b1, whose columns are all along v.
  const GgxVector<V> r0 = {xx - nu, xy, xz}, r1 = {xy, yy - nu, yz}, r2 = {xz, yz, zz - nu};
  const GgxVector<V> v = {DotOf(CrossOf(r1, r2), b1), DotOf(CrossOf(r2, r0), b1), DotOf(CrossOf(r0, r1), b1)};
  c.v = Times(one / Root(DotOf(v, v)), v);
  return c;
}

// < D > over the disc of `tau` with fixed direction f; b_k as above. Adds `weight` times the gradient to gradient[5].
template <bool kGradient, class V>
HWY_INLINE V ConeMean(const GgxLobeUniform<V>& p, const GgxVector<V>& b1, const GgxVector<V>& b2,
                      const GgxVector<V>& b3, V h2, const GgxVector<V>& f, V tau, V weight, V* gradient) {
  const V one = Constant(tau, 1.0), two = Constant(tau, 2.0), zero = Constant(tau, 0.0);
  const V kappa = h2 - tau;
  const V w1 = one / tau, w2 = one / (two - tau), w3 = one / kappa;
  const V inverse_det = p.inv_a * p.inv_c;
  const V det = zero - w1 * w2 * w3 * inverse_det * inverse_det;
  const GgxConeAxis<V> c = ConeAxis(b1, b2, b3, w1, w2, w3, det);
  const V q1 = p.a * f.x + p.b * f.y, q2 = p.c * f.y;
  const V cf = f.z - p.slope_x * f.x - p.slope_y * f.y;
  const V along = c.v.z * cf - c.v.x * q1 - c.v.y * q2;  // v . A f
  const V over = one / (c.nu * c.slope);
  const V scale = Constant(tau, 2.0 * 0.318309886183790671537767526745028724) * w1 * Root(det * over);
  const V value = scale * along;
  if constexpr (kGradient) {
    const V inverse_slope = one / c.slope, inverse_nu = one / c.nu;
    const V three_nu = Constant(tau, 3.0) * c.nu;
    // d of each coordinate and the component c of w that it goes with; -d ln(a c) is `ends`.
    const V b_over_ac = p.b * inverse_det;
    const GgxVector<V> d[5] = {{zero - p.inv_a, b_over_ac, zero},
                               {zero, zero - p.inv_c, zero},
                               {zero - one, p.b * p.inv_c, zero},
                               {zero, zero - p.inv_c, zero},
                               {zero, zero - one, zero}};
    constexpr int kComponent[5] = {2, 2, 0, 0, 1};
    const V v_of[3] = {c.v.x, c.v.y, c.v.z};
    // v . d(A f)
    const V direct[5] = {zero - c.v.z * f.x, zero - c.v.z * f.y, zero - c.v.x * p.a * f.x, zero - c.v.x * f.y,
                         zero - c.v.y * p.c * f.y};
    const GgxVector<V> af = {zero - q1, zero - q2, cf};
    const GgxVector<V> p_af = {DotOf(c.row[0], af), DotOf(c.row[1], af), DotOf(c.row[2], af)};
    for (int j = 0; j < 5; ++j) {
      const GgxVector<V>& m = c.row[kComponent[j]];
      const V vc = v_of[kComponent[j]];
      const V vd = DotOf(c.v, d[j]), md = DotOf(m, d[j]);
      const V dnu = two * c.nu * vc * vd;
      const V da = two * md;
      const GgxVector<V> pm = {DotOf(c.row[0], m), DotOf(c.row[1], m), DotOf(c.row[2], m)};
      const V db = c.trace * da - two * DotOf(d[j], pm);
      const V dslope = (Constant(tau, 6.0) * c.nu - two * c.trace) * dnu - two * c.nu * da + db;
      // z = dP v less its part along v; dv = -((a - 3 nu) z - (P - nu) z) / p'.
      const V nuv = c.nu * vc;
      const GgxVector<V> z = {nuv * d[j].x + vd * m.x - dnu * c.v.x, nuv * d[j].y + vd * m.y - dnu * c.v.y,
                              nuv * d[j].z + vd * m.z - dnu * c.v.z};
      const V dv_af = zero - ((c.trace - three_nu + c.nu) * DotOf(z, af) - DotOf(z, p_af)) * inverse_slope;
      const V half_log = Constant(tau, -0.5) * (dnu * inverse_nu + dslope * inverse_slope);
      const V shrink = j == 2 || j == 4 ? half_log - one : half_log;
      gradient[j] = gradient[j] + weight * scale * (dv_af + direct[j] + along * shrink);
    }
  }
  return value;
}

template <class V>
HWY_INLINE GgxVector<V> Moved(const double* by, const GgxVector<V>& w, const GgxVector<V>& along,
                              const GgxVector<V>& across) {
  const V a = Constant(w.x, by[0]), b = Constant(w.x, by[1]), c = Constant(w.x, by[2]);
  return {a * w.x + b * along.x + c * across.x, a * w.y + b * along.y + c * across.y,
          a * w.z + b * along.z + c * across.z};
}

// < D > over both discs.
template <bool kGradient, class V>
HWY_INLINE V MeanDistribution(const GgxLobeUniform<V>& p, const GgxMeanRule& rule, const GgxPairFrame<V>& frame,
                              const GgxVector<V>& i, const GgxVector<V>& o, V* gradient) {
  const GgxVector<V> b1 = InLobe(p, frame.h), b2 = InLobe(p, frame.e2), b3 = InLobe(p, frame.e3);
  const V share = Constant(i.x, rule.detector_share), rest = Constant(i.x, 1 - rule.detector_share);
  const GgxVector<V> f = {share * i.x + rest * o.x, share * i.y + rest * o.y, share * i.z + rest * o.z};
  V mean = Constant(i.x, 0.0);
  if constexpr (kGradient) {
    for (int j = 0; j < 5; ++j) gradient[j] = mean;
  }
  for (int k = 0; k < rule.nodes; ++k) {
    const V weight = Constant(i.x, rule.weight[k]);
    mean =
        mean + weight * ConeMean<kGradient>(p, b1, b2, b3, frame.h2, f, Constant(i.x, rule.tau[k]), weight, gradient);
  }
  return mean;
}

// specular: mean of D G2 / (4 cos_i cos_o) as `rule` means it, the mean of D times a D-weighted mean of the rest;
// argument: mean of what the Fresnel factor is linear in, weighted by that. Both with their gradients.
template <bool kGradient, Masking kMasking, class V>
HWY_INLINE V MeanSpecular(const GgxLobeUniform<V>& p, const GgxMeanRule& rule, const GgxVector<V>& i,
                          const GgxVector<V>& o, V* argument, V* gradient, V* argument_gradient) {
  const V zero = Constant(i.x, 0.0), one = Constant(i.x, 1.0), four = Constant(i.x, 4.0);
  const GgxPairFrame<V> frame = FrameOfPair(i, o);
  V dmean[5];
  const V mean = MeanDistribution<kGradient>(p, rule, frame, i, o, dmean);
  const GgxVector<V> along_i = CrossOf(frame.e3, i), along_o = CrossOf(frame.e3, o);
  V weights = zero, sum = zero, moment = zero;
  V dweights[5] = {zero, zero, zero, zero, zero}, dsum[5] = {zero, zero, zero, zero, zero},
    dmoment[5] = {zero, zero, zero, zero, zero};
  for (const GgxMeanRule::Point& point : rule.points) {
    const GgxVector<V> wi = Moved(point.i, i, along_i, frame.e3), wo = Moved(point.o, o, along_o, frame.e3);
    const V weight = Constant(i.x, point.weight);
    V cos_d, dspecular[5];
    const V specular = GgxSpecular<kGradient, kMasking>(p, wi.x, wi.y, wi.z, wo.x, wo.y, wo.z, &cos_d, dspecular);
    const V cosines = rule.flux ? weight * wi.z * wo.z : weight;
    // D at this point, as in GgxSpecular.
    const V hx = wi.x + wo.x, hy = wi.y + wo.y, hz = wi.z + wo.z;
    const V y1 = (zero - hx - p.slope_x * hz) * p.inv_a;
    const V y2 = (zero - hy - p.slope_y * hz - p.b * y1) * p.inv_c;
    const V inverse_k = one / (hz * hz + y1 * y1 + y2 * y2);
    const V length2 = hx * hx + hy * hy + hz * hz, ratio = length2 * inverse_k;
    const V D = weight * four * p.quarter_inv_pi_det * (ratio * ratio);
    V q = cos_d;
    if (!rule.argument_is_cosine) {
      const V x = one - cos_d, x2 = x * x;
      q = x2 * x2 * x;
    }
    const V term = cosines * specular;
    weights = weights + D;
    sum = sum + term;
    moment = moment + term * q;
    if constexpr (kGradient) {
      const V z2 = y2 * p.inv_c, z1 = (y1 - p.b * z2) * p.inv_a, f = four * inverse_k;
      dweights[0] = dweights[0] + D * (f * z1 * hz);
      dweights[1] = dweights[1] + D * (f * z2 * hz);
      dweights[2] = dweights[2] + D * (f * p.a * z1 * y1 - one);
      dweights[3] = dweights[3] + D * (f * z2 * y1);
      dweights[4] = dweights[4] + D * (f * p.c * z2 * y2 - one);
      for (int j = 0; j < 5; ++j) {
        const V d = cosines * dspecular[j];
        dsum[j] = dsum[j] + d;
        dmoment[j] = dmoment[j] + d * q;
      }
    }
  }
  const V inverse_weights = one / weights;
  V scale = inverse_weights;
  if (rule.flux) scale = scale * Constant(i.x, rule.inverse_cosines) / (i.z * o.z);
  const V inverse_sum = one / sum;
  *argument = moment * inverse_sum;
  if constexpr (kGradient) {
    for (int j = 0; j < 5; ++j) {
      argument_gradient[j] = (dmoment[j] - *argument * dsum[j]) * inverse_sum;
      gradient[j] = scale * (dmean[j] * sum + mean * (dsum[j] - sum * inverse_weights * dweights[j]));
    }
  }
  return scale * mean * sum;
}
