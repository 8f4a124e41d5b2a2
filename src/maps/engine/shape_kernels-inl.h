// The two functions of the light, with derivatives by the shape (kernels-inl.h).

void Cosines(const Vec3& n, const LightArrays& lights, double* cosine) {
  for (std::size_t l = 0; l < lights.padded; l += kLanes) {
    Lanes x, y, z;
    Load(&lights.x[l], &x), Load(&lights.y[l], &y), Load(&lights.z[l], &z);
    Lanes c = n.x * x + n.y * y + n.z * z;
    WhereLit(c, &c);
    Store(c, cosine + l);
  }
}

void CosineDerivatives(const MapFrame& f, const LightArrays& lights, double* by_t, double* by_b) {
  for (std::size_t l = 0; l < lights.padded; l += kLanes) {
    Lanes x, y, z;
    Load(&lights.x[l], &x), Load(&lights.y[l], &y), Load(&lights.z[l], &z);
    const Lanes c = f.n.x * x + f.n.y * y + f.n.z * z;
    Lanes t = f.t.x * x + f.t.y * y + f.t.z * z, b = f.b.x * x + f.b.y * y + f.b.z * z;
    WhereLit(c, &t), WhereLit(c, &b);
    Store(t, by_t + l), Store(b, by_b + l);
  }
}

void IsotropicValue(double alpha, const Vec3& n, const LightArrays& lights, double* cosine, double* specular) {
  const double a2 = alpha * alpha, inverse = 1 / a2, rest = 1 - a2;
  const double so = std::sqrt(n.z * n.z + a2 * (1 - n.z * n.z)), factor = kInvPi * inverse / (n.z + so);
  for (std::size_t l = 0; l < lights.padded; l += kLanes) {
    Lanes x, y, z, square, s;
    Load(&lights.x[l], &x), Load(&lights.y[l], &y), Load(&lights.z[l], &z), Load(&lights.square[l], &square);
    Lanes c = n.x * x + n.y * y + n.z * z;
    const Lanes hz = c + n.z, hz2 = hz * hz, K = hz2 + (square - hz2) * inverse;
    WhereLit(c, &c);
    Root(a2 + rest * (c * c), &s);
    Store(c, cosine + l);
    Store(factor * (square * square) * c / (K * K * (c + s)), specular + l);
  }
}

void IsotropicGradient(double alpha, const MapFrame& f, const LightArrays& lights, double* cosine, double* specular,
                       double* const* dcosine, double* const* dspecular) {
  const Vec3 &n = f.n, &t = f.t, &b = f.b;
  const double a2 = alpha * alpha, inverse = 1 / a2, rest = 1 - a2;
  const double co = n.z, so = std::sqrt(co * co + a2 * (1 - co * co)), factor = kInvPi * inverse / (co + so);
  const double dlog_co = -(1 + co * rest / so) / (co + so);
  const double dlog_alpha = -2 - a2 * (1 - co * co) / (so * (co + so));
  for (std::size_t l = 0; l < lights.padded; l += kLanes) {
    Lanes x, y, z, square, s;
    Load(&lights.x[l], &x), Load(&lights.y[l], &y), Load(&lights.z[l], &z), Load(&lights.square[l], &square);
    Lanes c = n.x * x + n.y * y + n.z * z;
    const Lanes hz = c + co, hz2 = hz * hz, off = (square - hz2) * inverse, K = hz2 + off, below = c;
    WhereLit(below, &c);
    const Lanes c2 = c * c;
    Root(a2 + rest * c2, &s);
    // 1 / K, 1 / (c + s) and 1 / s from one division.
    const Lanes sum = c + s, sum_s = sum * s, one = 1.0 / (K * sum_s);
    const Lanes by_K = one * sum_s, K_one = K * one, by_sum = K_one * s, by_s = K_one * sum;
    const Lanes per_c = factor * (square * square) * (by_K * by_K) * by_sum, value = per_c * c;
    // d ln specular by h_z, i_z and ln alpha, times specular; 1 / i_z is multiplied out: it may be 0.
    const Lanes over_K = 2.0 * value * by_K, over_c = value * by_sum;
    const Lanes by_hz = over_K * hz * (2 * (inverse - 1)), by_co = value * dlog_co;
    const Lanes by_ci = per_c - over_c * (1.0 + c * rest * by_s);
    Store(c, cosine + l), Store(value, specular + l);
    Store(value * dlog_alpha + over_K * (2.0 * off) - over_c * (a2 * (1.0 - c2)) * by_s, dspecular[2] + l);
    Lanes tw = t.x * x + t.y * y + t.z * z, bw = b.x * x + b.y * y + b.z * z;
    Lanes by_t = by_hz * (tw + t.z) + by_ci * tw + by_co * t.z, by_b = by_hz * (bw + b.z) + by_ci * bw + by_co * b.z;
    WhereLit(below, &by_t), WhereLit(below, &by_b), WhereLit(below, &tw), WhereLit(below, &bw);
    Store(by_t, dspecular[0] + l), Store(by_b, dspecular[1] + l);
    Store(tw, dcosine[0] + l), Store(bw, dcosine[1] + l);
  }
}

// (q . t, q . b, q . n) of the directions x, y, z.
LOBEFIT_INLINE void Local(const MapFrame& f, const Lanes& x, const Lanes& y, const Lanes& z, Lanes* local) {
  local[0] = f.t.x * x + f.t.y * y + f.t.z * z;
  local[1] = f.b.x * x + f.b.y * y + f.b.z * z;
  local[2] = f.n.x * x + f.n.y * y + f.n.z * z;
}

// core/brdf/ggx_lobe-inl.h with a mean slope of 0, in the frame of the normal:
//   specular = |h|^4 i_z / (pi a c K^2 (i_z + s_i) (o_z + s_o)), s(u)^2 = u_z^2 + q1^2 + q2^2, q1 = a u_x + b u_y, q2 =
//   c u_y.
void AnisotropicLobe(const TwoWidths& widths, const LightArrays& lights, double* specular, double* const* dspecular) {
  const double a = widths.a, b = widths.b, c = widths.c;
  const MapFrame frame = widths.frame, turned[2] = {widths.turned[0], widths.turned[1]};
  // ln (o_z + s_o) and its derivatives by o and by (ln a, b, ln c).
  const double o[3] = {frame.t.z, frame.b.z, frame.n.z};
  const double p1 = a * o[0] + b * o[1], p2 = c * o[1], so = std::sqrt(o[2] * o[2] + p1 * p1 + p2 * p2);
  const double sum_o = o[2] + so, g = 1 / (so * sum_o);
  const double by_o[3] = {g * p1 * a, g * (p1 * b + p2 * c), g * (so + o[2])};
  const double by_width_o[3] = {g * p1 * a * o[0], g * p1 * o[1], g * p2 * p2};
  const double factor = kInvPi / (a * c * sum_o), inverse_a = 1 / a, inverse_c = 1 / c;
  for (std::size_t l = 0; l < lights.padded; l += kLanes) {
    Lanes x, y, z, square, i[3], si;
    Load(&lights.x[l], &x), Load(&lights.y[l], &y), Load(&lights.z[l], &z), Load(&lights.square[l], &square);
    Local(frame, x, y, z, i);
    const Lanes hz = i[2] + o[2], y1 = (i[0] + o[0]) * -inverse_a, y2 = (-1.0 * (i[1] + o[1]) - b * y1) * inverse_c;
    const Lanes K = hz * hz + y1 * y1 + y2 * y2, q1 = a * i[0] + b * i[1], q2 = c * i[1];
    Root(i[2] * i[2] + q1 * q1 + q2 * q2, &si);
    // 1 / K, 1 / (i_z + s_i) and 1 / (s_i (i_z + s_i)) from one division.
    const Lanes sum_i = i[2] + si, both = si * sum_i, one = 1.0 / (K * both), by_K = one * both, f = one * K;
    const Lanes rest = factor * (square * square) * (by_K * by_K) * (f * si);
    Lanes value = rest * i[2];
    WhereLit(i[2], &value);
    Store(value, specular + l);
    if (dspecular == nullptr) continue;
    // d ln K^-2: by h and by the widths, where y2 moves with b and y1.
    const Lanes z2 = y2 * inverse_c, z1 = (y1 - b * z2) * inverse_a, over_K = 4.0 * by_K;
    const Lanes by_h[3] = {over_K * z1, over_K * z2, over_K * hz * -1.0};
    const Lanes by_i[3] = {f * q1 * a, f * (q1 * b + q2 * c), f * (si + i[2])};
    Store(value * (over_K * (a * z1 * y1) - 1.0 - f * q1 * (a * i[0]) - by_width_o[0]), dspecular[2] + l);
    Store(value * (over_K * (z2 * y1) - f * q1 * i[1] - by_width_o[1]), dspecular[3] + l);
    Store(value * (over_K * (c * z2 * y2) - 1.0 - f * q2 * q2 - by_width_o[2]), dspecular[4] + l);
    for (int j = 0; j < 2; ++j) {
      Lanes di[3];
      Local(turned[j], x, y, z, di);
      const double dout[3] = {turned[j].t.z, turned[j].b.z, turned[j].n.z};
      Lanes dlog = All(-(by_o[0] * dout[0] + by_o[1] * dout[1] + by_o[2] * dout[2]));
      for (int k = 0; k < 3; ++k) dlog += by_h[k] * (di[k] + dout[k]) - by_i[k] * di[k];
      Lanes turn = value * dlog + rest * di[2];
      WhereLit(i[2], &turn);
      Store(turn, dspecular[j] + l);
    }
  }
}
