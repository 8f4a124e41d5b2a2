// Sums of products over lights for matrices of second derivatives and of errors (kernels-inl.h).

// With p = d cosine, q = d specular: a channel's column of shape j is d p_j + e q_j, e = f0 + (carried - f0) k; so sums
// over channels need P = sum d^2, Q = sum d e, R = sum e^2 alone, and the columns of amplitudes, A and B, are the same
// in all channels.
template <int kShape, int kChannels>
LOBEFIT_INLINE void AddSquaresOf(const LightTerms terms, const double* weight, MapMatrix* matrix) {
  constexpr bool kLobe = kShape > 2;
  constexpr int kPer = kLobe ? 2 : 1;
  MapMatrix& m = *matrix;
  double P = 0, d_f = 0, d_rest = 0, f_f = 0, f_rest = 0, rest_rest = 0;
  for (int c = 0; c < kChannels; ++c) {
    const Amplitudes& a = terms.amplitudes[c];
    const double rest = a.carried - a.f0;
    P += a.diffuse * a.diffuse, d_f += a.diffuse * a.f0, d_rest += a.diffuse * rest;
    f_f += a.f0 * a.f0, f_rest += a.f0 * rest, rest_rest += rest * rest;
  }
  Lanes shape[kShape * (kShape + 1) / 2] = {};
  for (std::size_t l = 0; l < terms.padded; l += kLanes) {
    Lanes w, k, p[2], q[kShape];
    Load(weight + l, &w), Load(terms.k + l, &k);
    for (int j = 0; j < 2; ++j) Load(terms.dcosine[j] + l, &p[j]);
    for (int j = 0; kLobe && j < kShape; ++j) Load(terms.dspecular[j] + l, &q[j]);
    const Lanes wP = w * P, wQ = w * (d_f + d_rest * k), wR = w * (f_f + (2 * f_rest + rest_rest * k) * k);
    for (int j = 0, at = 0; j < kShape; ++j) {
      Lanes u = {}, v = {};
      if (kLobe) u = wQ * q[j], v = wR * q[j];
      if (j < 2) u += wP * p[j];
      if (j < 2 && kLobe) v += wQ * p[j];
      for (int i = 0; i <= j; ++i, ++at) {
        if (i < 2) shape[at] += u * p[i];
        if (kLobe) shape[at] += v * q[i];
      }
    }
  }
  for (int j = 0, at = 0; j < kShape; ++j) {
    for (int i = 0; i <= j; ++i, ++at) m[j][i] += Total(shape[at]);
  }
  for (int a = 0; a < kPer; ++a) {
    Lanes by_p[2] = {}, by_q[kShape] = {}, by_kq[kShape] = {}, with_A = {}, with_B = {};
    for (std::size_t l = 0; l < terms.padded; l += kLanes) {
      Lanes w, A, S = {}, k = {};
      Load(weight + l, &w), Load(terms.cosine + l, &A);
      if (kLobe) Load(terms.specular + l, &S), Load(terms.k + l, &k);
      const Lanes B = S - k * S, own = w * (a == 0 ? A : B), k_own = k * own;
      with_A += own * A;
      if (a == 1) with_B += own * B;
      for (int j = 0; j < 2; ++j) {
        Lanes p;
        Load(terms.dcosine[j] + l, &p);
        by_p[j] += own * p;
      }
      for (int j = 0; kLobe && j < kShape; ++j) {
        Lanes q;
        Load(terms.dspecular[j] + l, &q);
        by_q[j] += own * q, by_kq[j] += k_own * q;
      }
    }
    for (int c = 0; c < kChannels; ++c) {
      const Amplitudes& of = terms.amplitudes[c];
      const int row = kShape + kPer * c + a;
      for (int j = 0; j < kShape; ++j) {
        if (j < 2) m[row][j] += of.diffuse * Total(by_p[j]);
        if (kLobe) m[row][j] += of.f0 * Total(by_q[j]) + (of.carried - of.f0) * Total(by_kq[j]);
      }
      m[row][kShape + kPer * c] += Total(with_A);
      if (a == 1) m[row][row] += Total(with_B);
    }
  }
}

// Blocks of three rows by three.
void AddGram(const double* factor, const double* const* rows, int count, std::size_t padded, MapMatrix* matrix) {
  for (int j0 = 0; j0 < count; j0 += 3) {
    for (int k0 = 0; k0 <= j0; k0 += 3) {
      const double *left[3], *right[3];
      // The last row again where fewer than three are left.
      for (int i = 0; i < 3; ++i) left[i] = rows[j0 + i < count ? j0 + i : count - 1];
      for (int i = 0; i < 3; ++i) right[i] = rows[k0 + i < count ? k0 + i : count - 1];
      Lanes s00 = {}, s01 = {}, s02 = {}, s10 = {}, s11 = {}, s12 = {}, s20 = {}, s21 = {}, s22 = {};
      for (std::size_t l = 0; l < padded; l += kLanes) {
        Lanes f, a, b, c, x, y, z;
        Load(factor + l, &f);
        Load(left[0] + l, &a), Load(left[1] + l, &b), Load(left[2] + l, &c);
        Load(right[0] + l, &x), Load(right[1] + l, &y), Load(right[2] + l, &z);
        a *= f, b *= f, c *= f;
        s00 += a * x, s01 += a * y, s02 += a * z;
        s10 += b * x, s11 += b * y, s12 += b * z;
        s20 += c * x, s21 += c * y, s22 += c * z;
      }
      const double sums[3][3] = {{Total(s00), Total(s01), Total(s02)},
                                 {Total(s10), Total(s11), Total(s12)},
                                 {Total(s20), Total(s21), Total(s22)}};
      for (int j = 0; j < 3 && j0 + j < count; ++j) {
        for (int k = 0; k < 3 && k0 + k <= j0 + j; ++k) (*matrix)[j0 + j][k0 + k] += sums[j][k];
      }
    }
  }
}

// With W = w 1 + bend r r^T, J the channels' rows and A^-1 the inverse: moved = A^-1 J^T (p x + (1 - p) w r), p =
// kJackknife, (1 - W J A^-1 J^T) x = w r.
template <int kShape, int kChannels>
LOBEFIT_INLINE void MovesOfTerms(const LightTerms terms, const RowArrays arrays, const MapMatrix inverse,
                                 double* const* moved) {
  constexpr bool kLobe = kShape > 2;
  constexpr int kPer = kLobe ? 2 : 1, kUnknowns = kShape + kPer * kChannels, kOwn = kShape + kPer;
  for (std::size_t l = 0; l < terms.padded; l += kLanes) {
    Lanes A, S = {}, k = {}, w, bend;
    Load(terms.cosine + l, &A), Load(arrays.weight + l, &w), Load(arrays.bend + l, &bend);
    if (kLobe) Load(terms.specular + l, &S), Load(terms.k + l, &k);
    // Columns of a channel: of the shape, then its own amplitudes.
    Lanes J[kChannels][kOwn], V[kChannels][kUnknowns], r[kChannels];
    for (int c = 0; c < kChannels; ++c) {
      const Amplitudes& a = terms.amplitudes[c];
      Load(arrays.residual[c] + l, &r[c]);
      for (int j = 0; j < kShape; ++j) {
        Lanes column = {};
        if (j < 2) {
          Load(terms.dcosine[j] + l, &column);
          column *= a.diffuse;
        }
        if (kLobe) {
          Lanes q;
          Load(terms.dspecular[j] + l, &q);
          column += (a.f0 + (a.carried - a.f0) * k) * q;
        }
        J[c][j] = column;
      }
      J[c][kShape] = A;
      if (kLobe) J[c][kOwn - 1] = S - k * S;
      for (int i = 0; i < kUnknowns; ++i) {
        Lanes sum = {};
        for (int j = 0; j < kShape; ++j) sum += inverse[i][j] * J[c][j];
        for (int a_at = 0; a_at < kPer; ++a_at) sum += inverse[i][kShape + kPer * c + a_at] * J[c][kShape + a_at];
        V[c][i] = sum;
      }
    }
    Lanes G[kChannels][kChannels], M[kChannels][kChannels], x[kChannels];  // G = J A^-1 J^T
    for (int c = 0; c < kChannels; ++c) {
      for (int e = 0; e < kChannels; ++e) {
        Lanes sum = {};
        for (int j = 0; j < kShape; ++j) sum += J[c][j] * V[e][j];
        for (int a = 0; a < kPer; ++a) sum += J[c][kShape + a] * V[e][kShape + kPer * c + a];
        G[c][e] = sum;
      }
    }
    for (int c = 0; c < kChannels; ++c) {
      for (int e = 0; e < kChannels; ++e) {
        Lanes rG = {};
        for (int i = 0; i < kChannels; ++i) rG += r[i] * G[i][e];
        M[c][e] = (c == e ? 1.0 : 0.0) - (w * G[c][e] + bend * r[c] * rG);
      }
      x[c] = w * r[c];
    }
    // By elimination without pivots: M is near the identity.
    for (int j = 0; j < kChannels; ++j) {
      for (int i = j + 1; i < kChannels; ++i) {
        const Lanes factor = M[i][j] / M[j][j];
        for (int e = j; e < kChannels; ++e) M[i][e] -= factor * M[j][e];
        x[i] -= factor * x[j];
      }
    }
    for (int j = kChannels - 1; j >= 0; --j) {
      for (int i = j + 1; i < kChannels; ++i) x[j] -= M[j][i] * x[i];
      x[j] /= M[j][j];
    }
    for (int c = 0; c < kChannels; ++c) x[c] = kJackknife * x[c] + (1 - kJackknife) * (w * r[c]);
    for (int i = 0; i < kUnknowns; ++i) {
      Lanes sum = {};
      for (int c = 0; c < kChannels; ++c) sum += V[c][i] * x[c];
      Store(sum, moved[i] + l);
    }
  }
}

// pull[j] = A^-1 J^T W y for the first two unknowns, y the prediction; A^-1 and W as above.
template <int kShape, int kChannels>
LOBEFIT_INLINE void PullsOfTerms(const LightTerms terms, const RowArrays arrays, const MapMatrix inverse,
                                 double* const* pull) {
  constexpr bool kLobe = kShape > 2;
  constexpr int kPer = kLobe ? 2 : 1;
  for (std::size_t l = 0; l < terms.padded; l += kLanes) {
    Lanes A, S = {}, k = {}, w, bend, live, sums[2] = {}, along = {};
    Load(terms.cosine + l, &A), Load(arrays.weight + l, &w), Load(arrays.bend + l, &bend), Load(terms.live + l, &live);
    if (kLobe) Load(terms.specular + l, &S), Load(terms.k + l, &k);
    const Lanes B = S - k * S;
    Lanes r[kChannels], y[kChannels];
    for (int c = 0; c < kChannels; ++c) {
      const Amplitudes& a = terms.amplitudes[c];
      Load(arrays.residual[c] + l, &r[c]);
      y[c] = a.diffuse * A;
      if (kLobe) y[c] += (a.f0 + (a.carried - a.f0) * k) * S;
      along += r[c] * y[c];
    }
    for (int c = 0; c < kChannels; ++c) {
      const Amplitudes& a = terms.amplitudes[c];
      const Lanes x = live * (w * y[c] + bend * r[c] * along);
      for (int i = 0; i < 2; ++i) {
        Lanes column = inverse[i][kShape + kPer * c] * A;
        if (kLobe) column += inverse[i][kShape + kPer * c + kPer - 1] * B;
        for (int j = 0; j < kShape; ++j) {
          Lanes p = {}, q = {};
          if (j < 2) Load(terms.dcosine[j] + l, &p), column += inverse[i][j] * a.diffuse * p;
          if (kLobe) Load(terms.dspecular[j] + l, &q), column += (inverse[i][j] * (a.f0 + (a.carried - a.f0) * k)) * q;
        }
        sums[i] += column * x;
      }
    }
    for (int i = 0; i < 2; ++i) Store(sums[i], pull[i] + l);
  }
}

double SmoothSquares(const BumpCenters& centers, double share, const LightArrays& lights, const double* left,
                     const double* right) {
  constexpr std::size_t kBumps = std::tuple_size_v<BumpCenters>;
  Lanes sums[2][kBumps] = {}, apart = {};
  for (std::size_t l = 0; l < lights.padded; l += kLanes) {
    Lanes x, y, z, a, b, bumps[kBumps], square = {}, length;
    Load(&lights.x[l], &x), Load(&lights.y[l], &y), Load(&lights.z[l], &z), Load(left + l, &a), Load(right + l, &b);
    for (std::size_t g = 0; g < kBumps; ++g) {
      const Vec3 v = 0.5 * centers[g];
      const Lanes half = 0.5 + (v.x * x + v.y * y + v.z * z), two = half * half, four = two * two;
      bumps[g] = four * four, square += bumps[g] * bumps[g];
    }
    // All bumps of a light together are of length 1.
    Root(square, &length);
    const Lanes left_over = a / length, right_over = b / length;
    for (std::size_t g = 0; g < kBumps; ++g) sums[0][g] += bumps[g] * left_over, sums[1][g] += bumps[g] * right_over;
    apart += a * a + b * b;
  }
  double smooth = 0;
  for (std::size_t g = 0; g < kBumps; ++g) {
    const double a = Total(sums[0][g]), b = Total(sums[1][g]);
    smooth += a * a + b * b;
  }
  return share * smooth + (1 - share) * Total(apart);
}
