// The lobe about any mean slope, seen from anywhere (kernels-inl.h).

// c_u + s of G1(u) = 2 u_z / (c_u + s), c_u = u_z - x_s u_x - y_s u_y, s^2 = c_u^2 + q1^2 + q2^2, and what its
// logarithm changes by: with u, and with the numbers of the shape. At least 2 u_z, where it does not change with the
// latter.
struct SlopeSum {
  Lanes sum, by_u[3], by_slope[2], by_width[3];
};

LOBEFIT_INLINE void SumOf(const TwoWidths& w, const MeanSlope& slope, const Lanes* u, SlopeSum* out) {
  const Lanes c = u[2] - slope.x * u[0] - slope.y * u[1], q1 = w.a * u[0] + w.b * u[1], q2 = w.c * u[1];
  const Lanes q = q1 * q1 + q2 * q2;
  Lanes s, sum;
  Root(c * c + q, &s);
  WhereNegative(c, q / (s - c), c + s, &sum);
  // Straight down both are 0.
  const Lanes g = 1.0 / (s * sum + 1e-300), over_s = sum * g, zero = {};
  const Lanes by_q1 = g * q1, by_q2 = g * q2;
  const Lanes by_u[3] = {by_q1 * w.a - slope.x * over_s, by_q1 * w.b + by_q2 * w.c - slope.y * over_s, over_s};
  const Lanes by_slope[2] = {-1.0 * (u[0] * over_s), -1.0 * (u[1] * over_s)};
  const Lanes by_width[3] = {by_q1 * (w.a * u[0]), by_q1 * u[1], by_q2 * q2};
  const Lanes least = 2.0 * u[2], excess = sum - least;
  WhereNegative(excess, least, sum, &out->sum);
  const Lanes by_least[3] = {zero, zero, 1.0 / u[2]};
  for (int j = 0; j < 3; ++j) WhereNegative(excess, by_least[j], by_u[j], &out->by_u[j]);
  for (int j = 0; j < 2; ++j) WhereNegative(excess, zero, by_slope[j], &out->by_slope[j]);
  for (int j = 0; j < 3; ++j) WhereNegative(excess, zero, by_width[j], &out->by_width[j]);
}

// core/brdf/ggx_lobe-inl.h in the frame of the normal:
//   specular = |h|^4 i_z / (pi a c K^2 (c_i + s_i) (c_o + s_o)).
void GeneralLobe(const TwoWidths& widths, const MeanSlope& slope, const LightArrays& lights, double* specular,
                 double* const* dspecular) {
  const double b = widths.b, inverse_a = 1 / widths.a, inverse_c = 1 / widths.c;
  const double factor = kInvPi * inverse_a * inverse_c;
  const MapFrame frame = widths.frame, turned[2] = {widths.turned[0], widths.turned[1]};
  for (std::size_t l = 0; l < lights.padded; l += kLanes) {
    Lanes x, y, z, ox, oy, oz, square, i[3], o[3];
    Load(&lights.x[l], &x), Load(&lights.y[l], &y), Load(&lights.z[l], &z), Load(&lights.square[l], &square);
    Load(&lights.out_x[l], &ox), Load(&lights.out_y[l], &oy), Load(&lights.out_z[l], &oz);
    Local(frame, x, y, z, i), Local(frame, ox, oy, oz, o);
    SlopeSum in, out;
    SumOf(widths, slope, i, &in), SumOf(widths, slope, o, &out);
    const Lanes hz = i[2] + o[2], y1 = (i[0] + o[0] + slope.x * hz) * -inverse_a;
    const Lanes y2 = (-1.0 * (i[1] + o[1] + slope.y * hz) - b * y1) * inverse_c;
    const Lanes K = hz * hz + y1 * y1 + y2 * y2, by_K = 1.0 / K;
    const Lanes rest = factor * (square * square) * (by_K * by_K) / (in.sum * out.sum);
    Lanes value = rest * i[2];
    WhereLit(i[2], &value), WhereLit(o[2], &value);
    Store(value, specular + l);
    if (dspecular == nullptr) continue;
    const Lanes z2 = y2 * inverse_c, z1 = (y1 - b * z2) * inverse_a, over_K = 4.0 * by_K;
    Store(value * (over_K * (widths.a * z1 * y1) - 1.0 - in.by_width[0] - out.by_width[0]), dspecular[2] + l);
    Store(value * (over_K * (z2 * y1) - in.by_width[1] - out.by_width[1]), dspecular[3] + l);
    Store(value * (over_K * (widths.c * z2 * y2) - 1.0 - in.by_width[2] - out.by_width[2]), dspecular[4] + l);
    if (slope.is_free) {
      Store(value * (over_K * (z1 * hz) - in.by_slope[0] - out.by_slope[0]), dspecular[0] + l);
      Store(value * (over_K * (z2 * hz) - in.by_slope[1] - out.by_slope[1]), dspecular[1] + l);
      continue;
    }
    const Lanes by_h[3] = {over_K * z1, over_K * z2, over_K * (slope.x * z1 + slope.y * z2 - hz)};
    for (int j = 0; j < 2; ++j) {
      Lanes di[3], dout[3], dlog = {};
      Local(turned[j], x, y, z, di), Local(turned[j], ox, oy, oz, dout);
      for (int k = 0; k < 3; ++k) {
        dlog += by_h[k] * (di[k] + dout[k]) - in.by_u[k] * di[k] - out.by_u[k] * dout[k];
      }
      Lanes turn = value * dlog + rest * di[2];
      WhereLit(i[2], &turn), WhereLit(o[2], &turn);
      Store(turn, dspecular[j] + l);
    }
  }
}
