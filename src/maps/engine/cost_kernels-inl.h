// Amplitudes, cost and gradient of a texel (kernels-inl.h).

template <bool kLobe, int kChannels>
LOBEFIT_INLINE void SumAmplitudesOf(const LightTerms terms, const double* weight, AmplitudeSums* sums) {
  Lanes aa = {}, ab = {}, bb = {}, ay[kChannels] = {}, by[kChannels] = {};
  const double carried = terms.amplitudes[0].carried;
  for (std::size_t l = 0; l < terms.padded; l += kLanes) {
    Lanes w, A, S = {}, k = {};
    Load(weight + l, &w), Load(terms.cosine + l, &A);
    if (kLobe) Load(terms.specular + l, &S), Load(terms.k + l, &k);
    const Lanes kS = k * S, B = S - kS, C = carried * kS, wA = w * A, wB = w * B;
    aa += wA * A;
    if (kLobe) ab += wA * B, bb += wB * B;
    for (int c = 0; c < kChannels; ++c) {
      Lanes y;
      Load(terms.values[c] + l, &y);
      if (kLobe) y -= C;
      ay[c] += wA * y;
      if (kLobe) by[c] += wB * y;
    }
  }
  for (int c = 0; c < kChannels; ++c) sums[c] = {Total(aa), Total(ab), Total(bb), Total(ay[c]), Total(by[c])};
}

// Residual of a channel.
template <bool kLobe>
LOBEFIT_INLINE void Residual(const LightTerms& terms, int channel, std::size_t l, const Lanes& A, const Lanes& S,
                             const Lanes& k, const Lanes& live, Lanes* r) {
  const Amplitudes& a = terms.amplitudes[channel];
  Lanes y;
  Load(terms.values[channel] + l, &y);
  *r = a.diffuse * A - y;
  if (kLobe) *r += (a.f0 + (a.carried - a.f0) * k) * S;
  *r *= live;
}

// The cost, or, where kWeigh, the loss's weights alone.
template <bool kLobe, int kChannels, bool kWeigh>
LOBEFIT_INLINE double CostOfTerms(const LightTerms terms, double* weight) {
  const double inverse = 1 / (terms.loss * terms.loss);
  LogSum logarithm;
  for (std::size_t l = 0; l < terms.padded; l += kLanes) {
    Lanes A, S = {}, k = {}, live, square = {};
    Load(terms.cosine + l, &A), Load(terms.live + l, &live);
    if (kLobe) Load(terms.specular + l, &S), Load(terms.k + l, &k);
    for (int c = 0; c < kChannels; ++c) {
      Lanes r;
      Residual<kLobe>(terms, c, l, A, S, k, live, &r);
      square += r * r;
    }
    square *= inverse;
    if (kWeigh) Store(live / (1.0 + square), weight + l);
    if (!kWeigh) logarithm.Add(square);
  }
  return kWeigh ? 0 : 0.5 * terms.loss * terms.loss * logarithm.Value();
}

// Gradient and cost; with kRows also what the loss bends the second derivatives by.
template <int kShape, int kChannels, bool kRows>
LOBEFIT_INLINE double RowsOfTerms(const LightTerms terms, Curvature curvature, const RowArrays arrays,
                                  double* gradient) {
  constexpr bool kLobe = kShape > 2;
  constexpr int kPer = kLobe ? 2 : 1;
  constexpr double kLeast = 0.05;  // of the weight that curvature along the residual keeps where it is clipped
  const double inverse = 1 / (terms.loss * terms.loss);
  const double most = curvature == Curvature::kClipped ? 1 - kLeast : 1e300;
  LogSum logarithm;
  Lanes sums[kShape + kPer * kChannels] = {};
  for (std::size_t l = 0; l < terms.padded; l += kLanes) {
    Lanes A, S = {}, k = {}, live, square = {}, along_p = {}, along_q = {};
    Load(terms.cosine + l, &A), Load(terms.live + l, &live);
    if (kLobe) Load(terms.specular + l, &S), Load(terms.k + l, &k);
    Lanes r[kChannels];
    for (int c = 0; c < kChannels; ++c) {
      const Amplitudes& a = terms.amplitudes[c];
      Residual<kLobe>(terms, c, l, A, S, k, live, &r[c]);
      if (kRows) Store(r[c], arrays.residual[c] + l);
      square += r[c] * r[c];
      along_p += a.diffuse * r[c];
      if (kLobe) along_q += (a.f0 + (a.carried - a.f0) * k) * r[c];
    }
    const Lanes scaled = square * inverse;
    logarithm.Add(scaled);
    Lanes w;
    if (kRows) {
      // 1 / (1 + scaled) and 1 / |r|^2 from one division; bend is not below -most w / |r|^2.
      const Lanes above = 1.0 + scaled, positive = square + 1e-300, one = 1.0 / (above * positive);
      w = live * (one * positive);
      Store(Larger(w * w * (-2 * inverse), -most * w * (one * above)), arrays.bend + l);
    } else {
      w = live / (1.0 + scaled);
    }
    Store(w, arrays.weight + l);
    for (int j = 0; j < kShape; ++j) {
      Lanes row = {};
      if (j < 2) {
        Lanes p;
        Load(terms.dcosine[j] + l, &p);
        row = along_p * p;
      }
      if (kLobe) {
        Lanes q;
        Load(terms.dspecular[j] + l, &q);
        row += along_q * q;
      }
      if (kRows) Store(row, arrays.rows[j] + l);
      sums[j] += w * row;
    }
    const Lanes B = S - k * S;
    for (int c = 0; c < kChannels; ++c) {
      const Lanes diffuse = r[c] * A;
      if (kRows) Store(diffuse, arrays.rows[kShape + kPer * c] + l);
      sums[kShape + kPer * c] += w * diffuse;
      if (!kLobe) continue;
      const Lanes f0 = r[c] * B;
      if (kRows) Store(f0, arrays.rows[kShape + 2 * c + 1] + l);
      sums[kShape + kPer * c + kPer - 1] += w * f0;
    }
  }
  for (int j = 0; j < kShape + kPer * kChannels; ++j) gradient[j] = Total(sums[j]);
  return 0.5 * terms.loss * terms.loss * logarithm.Value();
}
