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
