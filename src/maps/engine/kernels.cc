#include "lobefit/maps/engine/kernels.h"

#include <cmath>
#include <cstring>
#include <tuple>

// The same text for each instruction set; both compilers take the words of g++ or their own.
#if defined(__clang__)
#define LOBEFIT_WITH(set) LOBEFIT_PRAGMA(clang attribute push(__attribute__((target(set))), apply_to = function))
#define LOBEFIT_WITHOUT LOBEFIT_PRAGMA(clang attribute pop)
#else
#define LOBEFIT_WITH(set) LOBEFIT_PRAGMA(GCC push_options) LOBEFIT_PRAGMA(GCC target(set))
#define LOBEFIT_WITHOUT LOBEFIT_PRAGMA(GCC pop_options)
#endif
#define LOBEFIT_PRAGMA(text) _Pragma(#text)

namespace lobefit {
namespace {

namespace plain {
constexpr std::size_t kWidth = 2;
#include "lobefit/maps/engine/kernels-inl.h"
}  // namespace plain

#if defined(__x86_64__)
LOBEFIT_WITH("avx2")
namespace avx2 {
constexpr std::size_t kWidth = 4;
#include "lobefit/maps/engine/kernels-inl.h"
}  // namespace avx2
LOBEFIT_WITHOUT

LOBEFIT_WITH("avx512f,avx512dq")
namespace avx512 {
constexpr std::size_t kWidth = 8;
#include "lobefit/maps/engine/kernels-inl.h"
}  // namespace avx512
LOBEFIT_WITHOUT
#endif

// What the loops are called through.
struct Kernels {
  decltype(&plain::Cosines) cosines;
  decltype(&plain::CosineDerivatives) cosine_derivatives;
  decltype(&plain::IsotropicValue) isotropic_value;
  decltype(&plain::IsotropicGradient) isotropic_gradient;
  decltype(&plain::AnisotropicLobe) anisotropic_lobe;
  decltype(&plain::GeneralLobe) general_lobe;
  decltype(&plain::SumAmplitudes) sum_amplitudes;
  decltype(&plain::CostOf) cost_of;
  decltype(&plain::WeightsOf) weights_of;
  decltype(&plain::RowsOf) rows_of;
  decltype(&plain::AddSquares) add_squares;
  decltype(&plain::AddGram) add_gram;
  decltype(&plain::MovesOf) moves_of;
  decltype(&plain::PullsOf) pulls_of;
  decltype(&plain::SmoothSquares) smooth_squares;
};

#define LOBEFIT_KERNELS(set)                                                                                           \
  Kernels {                                                                                                            \
    set::Cosines, set::CosineDerivatives, set::IsotropicValue, set::IsotropicGradient, set::AnisotropicLobe,           \
        set::GeneralLobe, set::SumAmplitudes, set::CostOf, set::WeightsOf, set::RowsOf, set::AddSquares, set::AddGram, \
        set::MovesOf, set::PullsOf, set::SmoothSquares                                                                 \
  }

Kernels Choose() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) return LOBEFIT_KERNELS(avx512);
  if (__builtin_cpu_supports("avx2")) return LOBEFIT_KERNELS(avx2);
#endif
  return LOBEFIT_KERNELS(plain);
}

const Kernels kKernels = Choose();

}  // namespace

void Cosines(const Vec3& normal, const LightArrays& lights, double* cosine) {
  kKernels.cosines(normal, lights, cosine);
}
void CosineDerivatives(const MapFrame& frame, const LightArrays& lights, double* by_t, double* by_b) {
  kKernels.cosine_derivatives(frame, lights, by_t, by_b);
}
void IsotropicValue(double alpha, const Vec3& normal, const LightArrays& lights, double* cosine, double* specular) {
  kKernels.isotropic_value(alpha, normal, lights, cosine, specular);
}
void IsotropicGradient(double alpha, const MapFrame& frame, const LightArrays& lights, double* cosine, double* specular,
                       double* const* dcosine, double* const* dspecular) {
  kKernels.isotropic_gradient(alpha, frame, lights, cosine, specular, dcosine, dspecular);
}
void AnisotropicLobe(const TwoWidths& widths, const LightArrays& lights, double* specular, double* const* dspecular) {
  kKernels.anisotropic_lobe(widths, lights, specular, dspecular);
}
void GeneralLobe(const TwoWidths& widths, const MeanSlope& slope, const LightArrays& lights, double* specular,
                 double* const* dspecular) {
  kKernels.general_lobe(widths, slope, lights, specular, dspecular);
}
void SumAmplitudes(const LightTerms& terms, const double* weight, AmplitudeSums* sums) {
  kKernels.sum_amplitudes(terms, weight, sums);
}
double CostOf(const LightTerms& terms) { return kKernels.cost_of(terms); }
void WeightsOf(const LightTerms& terms, double* weight) { kKernels.weights_of(terms, weight); }
double RowsOf(const LightTerms& terms, Curvature curvature, const RowArrays& arrays, double* gradient) {
  return kKernels.rows_of(terms, curvature, arrays, gradient);
}
void AddSquares(const LightTerms& terms, const double* weight, MapMatrix* matrix) {
  kKernels.add_squares(terms, weight, matrix);
}
void AddGram(const double* factor, const double* const* rows, int count, std::size_t padded, MapMatrix* matrix) {
  kKernels.add_gram(factor, rows, count, padded, matrix);
}
void MovesOf(const LightTerms& terms, const RowArrays& arrays, const MapMatrix& inverse, double* const* moved) {
  kKernels.moves_of(terms, arrays, inverse, moved);
}
void PullsOf(const LightTerms& terms, const RowArrays& arrays, const MapMatrix& inverse, double* const* pull) {
  kKernels.pulls_of(terms, arrays, inverse, pull);
}
double SmoothSquares(const BumpCenters& centers, double share, const LightArrays& lights, const double* left,
                     const double* right) {
  return kKernels.smooth_squares(centers, share, lights, left, right);
}

}  // namespace lobefit
