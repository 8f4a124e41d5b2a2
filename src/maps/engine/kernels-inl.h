// The loops of kernels.h, compiled once for each instruction set inside a namespace of its own that says kWidth, the
// doubles of one of its vectors (kernels.cc).

#define LOBEFIT_INLINE inline __attribute__((always_inline))

// kLanes lights in as many vectors of the instruction set as that takes: g++ 12 keeps larger vectors in memory.
struct Lanes {
  static constexpr std::size_t kParts = kLanes / kWidth;
  using Part = double __attribute__((vector_size(kWidth * sizeof(double))));
  Part part[kParts];
  LOBEFIT_INLINE double operator[](std::size_t i) const { return part[i / kWidth][i % kWidth]; }
};

LOBEFIT_INLINE Lanes All(double x) {
  Lanes all;
  for (Lanes::Part& p : all.part) p = Lanes::Part{} + x;
  return all;
}

#define LOBEFIT_OPERATOR(sign)                                                              \
  LOBEFIT_INLINE Lanes operator sign(const Lanes& a, const Lanes& b) {                      \
    Lanes r;                                                                                \
    for (std::size_t p = 0; p < Lanes::kParts; ++p) r.part[p] = a.part[p] sign b.part[p];   \
    return r;                                                                               \
  }                                                                                         \
  LOBEFIT_INLINE Lanes operator sign(double a, const Lanes& b) { return All(a) sign b; }    \
  LOBEFIT_INLINE Lanes operator sign(const Lanes& a, double b) { return a sign All(b); }    \
  LOBEFIT_INLINE Lanes& operator sign##=(Lanes& a, const Lanes& b) { return a = a sign b; } \
  LOBEFIT_INLINE Lanes& operator sign##=(Lanes& a, double b) { return a = a sign All(b); }
LOBEFIT_OPERATOR(+)
LOBEFIT_OPERATOR(-)
LOBEFIT_OPERATOR(*)
LOBEFIT_OPERATOR(/)
#undef LOBEFIT_OPERATOR

LOBEFIT_INLINE void Load(const double* from, Lanes* to) {
  std::memcpy(to->part, __builtin_assume_aligned(from, sizeof(Lanes)), sizeof(Lanes));
}
LOBEFIT_INLINE void Store(const Lanes& from, double* to) {
  std::memcpy(__builtin_assume_aligned(to, sizeof(Lanes)), from.part, sizeof(Lanes));
}
LOBEFIT_INLINE void Root(const Lanes& x, Lanes* root) {
  for (std::size_t p = 0; p < Lanes::kParts; ++p) {
    for (std::size_t i = 0; i < kWidth; ++i) root->part[p][i] = __builtin_sqrt(x.part[p][i]);
  }
}
// a where a > b, else b.
LOBEFIT_INLINE Lanes Larger(const Lanes& a, const Lanes& b) {
  Lanes r;
  for (std::size_t p = 0; p < Lanes::kParts; ++p) r.part[p] = a.part[p] > b.part[p] ? a.part[p] : b.part[p];
  return r;
}
// x where c > 0, else 0.
LOBEFIT_INLINE void WhereLit(const Lanes& c, Lanes* x) {
  for (std::size_t p = 0; p < Lanes::kParts; ++p) x->part[p] = c.part[p] > 0.0 ? x->part[p] : Lanes::Part{};
}
// a where c < 0, else b.
LOBEFIT_INLINE void WhereNegative(const Lanes& c, const Lanes& a, const Lanes& b, Lanes* x) {
  for (std::size_t p = 0; p < Lanes::kParts; ++p) x->part[p] = c.part[p] < 0.0 ? a.part[p] : b.part[p];
}
// By halves, which is few instructions on all sets.
LOBEFIT_INLINE double Total(const Lanes& s) {
  using Pair = double __attribute__((vector_size(2 * sizeof(double))));
  Pair pair[kLanes / 2];
  std::memcpy(pair, s.part, sizeof(Lanes));
  const Pair sum = (pair[0] + pair[2]) + (pair[1] + pair[3]);
  return sum[0] + sum[1];
}

// Sum of ln(1 + x) >= 0 with one logarithm for many terms: e -> e + x + e x is the product less 1, exact near 0.
struct LogSum {
  static constexpr std::size_t kFlush = 16;
  static constexpr double kLarge = 1e35;  // the product of kLanes of them is a number
  Lanes product = {};
  std::size_t terms = 0;
  double rest = 0, sum = 0;

  LOBEFIT_INLINE void Add(const Lanes& x) {
    product += x + product * x;
    if (++terms == kFlush) Flush();
  }
  static LOBEFIT_INLINE double Joined(double a, double b) { return a + b + a * b; }
  LOBEFIT_INLINE void Join(double x) {
    if (rest > kLarge || x > kLarge) sum += std::log1p(rest), rest = 0;
    rest = Joined(rest, x);
  }
  LOBEFIT_INLINE void Flush() {
    double e[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) e[i] = product[i];
    // Most often all together, by pairs.
    const double most = std::fmax(std::fmax(std::fmax(e[0], e[1]), std::fmax(e[2], e[3])),
                                  std::fmax(std::fmax(e[4], e[5]), std::fmax(e[6], e[7])));
    if (most < kLarge) {
      Join(Joined(Joined(Joined(e[0], e[1]), Joined(e[2], e[3])), Joined(Joined(e[4], e[5]), Joined(e[6], e[7]))));
    } else {
      for (const double x : e) Join(x);
    }
    product = Lanes{}, terms = 0;
  }
  LOBEFIT_INLINE double Value() {
    Flush();
    return sum + std::log1p(rest);
  }
};

#include "lobefit/maps/engine/cost_kernels-inl.h"
#include "lobefit/maps/engine/matrix_kernels-inl.h"
#include "lobefit/maps/engine/shape_kernels-inl.h"
#include "lobefit/maps/engine/views_kernels-inl.h"

void SumAmplitudes(const LightTerms& terms, const double* weight, AmplitudeSums* sums) {
  const bool lobe = terms.shape > 2, color = terms.channels == 3;
  if (lobe && color) return SumAmplitudesOf<true, 3>(terms, weight, sums);
  if (lobe) return SumAmplitudesOf<true, 1>(terms, weight, sums);
  if (color) return SumAmplitudesOf<false, 3>(terms, weight, sums);
  SumAmplitudesOf<false, 1>(terms, weight, sums);
}

double CostOf(const LightTerms& terms) {
  const bool lobe = terms.shape > 2, color = terms.channels == 3;
  if (lobe && color) return CostOfTerms<true, 3, false>(terms, nullptr);
  if (lobe) return CostOfTerms<true, 1, false>(terms, nullptr);
  return color ? CostOfTerms<false, 3, false>(terms, nullptr) : CostOfTerms<false, 1, false>(terms, nullptr);
}

void WeightsOf(const LightTerms& terms, double* weight) {
  const bool lobe = terms.shape > 2, color = terms.channels == 3;
  if (lobe && color) CostOfTerms<true, 3, true>(terms, weight);
  if (lobe && !color) CostOfTerms<true, 1, true>(terms, weight);
  if (!lobe && color) CostOfTerms<false, 3, true>(terms, weight);
  if (!lobe && !color) CostOfTerms<false, 1, true>(terms, weight);
}

// Calls `function`<shape, channels> with those of the terms.
#define LOBEFIT_BY_SIZE(function, ...)                                                            \
  const bool color = terms.channels == 3;                                                         \
  if (terms.shape == 2) return color ? function<2, 3>(__VA_ARGS__) : function<2, 1>(__VA_ARGS__); \
  if (terms.shape == 3) return color ? function<3, 3>(__VA_ARGS__) : function<3, 1>(__VA_ARGS__); \
  return color ? function<5, 3>(__VA_ARGS__) : function<5, 1>(__VA_ARGS__)

template <int kShape, int kChannels>
LOBEFIT_INLINE double RowsOfSize(const LightTerms& terms, Curvature curvature, const RowArrays& arrays,
                                 double* gradient) {
  if (curvature == Curvature::kNone) return RowsOfTerms<kShape, kChannels, false>(terms, curvature, arrays, gradient);
  return RowsOfTerms<kShape, kChannels, true>(terms, curvature, arrays, gradient);
}
double RowsOf(const LightTerms& terms, Curvature curvature, const RowArrays& arrays, double* gradient) {
  LOBEFIT_BY_SIZE(RowsOfSize, terms, curvature, arrays, gradient);
}
void AddSquares(const LightTerms& terms, const double* weight, MapMatrix* matrix) {
  LOBEFIT_BY_SIZE(AddSquaresOf, terms, weight, matrix);
}
void MovesOf(const LightTerms& terms, const RowArrays& arrays, const MapMatrix& inverse, double* const* moved) {
  LOBEFIT_BY_SIZE(MovesOfTerms, terms, arrays, inverse, moved);
}
void PullsOf(const LightTerms& terms, const RowArrays& arrays, const MapMatrix& inverse, double* const* pull) {
  LOBEFIT_BY_SIZE(PullsOfTerms, terms, arrays, inverse, pull);
}

#undef LOBEFIT_BY_SIZE
#undef LOBEFIT_INLINE
