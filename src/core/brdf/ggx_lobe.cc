#include "lobefit/core/brdf/ggx_lobe.h"

#include <algorithm>
#include <cmath>

#ifndef LOBEFIT_CORE_GGX_LOBE_ARRAYS
#define LOBEFIT_CORE_GGX_LOBE_ARRAYS
namespace lobefit {
// Pointers of one call, the same for every target.
struct GgxArrays {
  const double* uniform;
  const double* const* in;
  double* const* out;
  std::size_t count;
};
}  // namespace lobefit
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ggx_lobe.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lobefit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D64 = hn::ScalableTag<double>;
using V64 = hn::Vec<D64>;

HWY_INLINE V64 Root(V64 x) { return hn::Sqrt(x); }
HWY_INLINE V64 Constant(V64 /*like*/, double value) { return hn::Set(D64(), value); }
HWY_INLINE V64 SelectNegative(V64 x, V64 yes, V64 no) { return hn::IfThenElse(hn::Lt(x, hn::Zero(D64())), yes, no); }

#include "lobefit/core/brdf/ggx_lobe-inl.h"

GgxLobeUniform<V64> Broadcast(const double* u) {
  const D64 d;
  return {hn::Set(d, u[0]), hn::Set(d, u[1]), hn::Set(d, u[2]), hn::Set(d, u[3]),
          hn::Set(d, u[4]), hn::Set(d, u[5]), hn::Set(d, u[6]), hn::Set(d, u[7])};
}

// What is computed for a vector of samples: inputs and outputs in the order of their arrays.
template <bool kGradient, Masking kMasking>
struct LobeKernel {
  static constexpr std::size_t kInputs = 6, kOutputs = kGradient ? 7 : 2;
  static HWY_INLINE void Evaluate(const GgxLobeUniform<V64>& p, const V64* x, V64* y) {
    y[0] = GgxSpecular<kGradient, kMasking>(p, x[0], x[1], x[2], x[3], x[4], x[5], &y[1], y + 2);
  }
};

template <bool kGradient>
struct DistributionKernel {
  static constexpr std::size_t kInputs = 3, kOutputs = kGradient ? 6 : 1;
  static HWY_INLINE void Evaluate(const GgxLobeUniform<V64>& p, const V64* x, V64* y) {
    y[0] = GgxDistribution<kGradient>(p, x[0], x[1], x[2], y + 1);
  }
};

template <bool kGradient, bool kClamp>
struct MaskingKernel {
  static constexpr std::size_t kInputs = 3, kOutputs = kGradient ? 6 : 1;
  static HWY_INLINE void Evaluate(const GgxLobeUniform<V64>& p, const V64* x, V64* y) {
    y[0] = GgxMaskingG1<kGradient, kClamp>(p, x[0], x[1], x[2], y + 1);
  }
};

template <class Kernel>
void Loop(const GgxArrays& arrays) {
  constexpr std::size_t kIn = Kernel::kInputs, kOut = Kernel::kOutputs;
  const D64 d;
  const GgxLobeUniform<V64> p = Broadcast(arrays.uniform);
  const std::size_t lanes = hn::Lanes(d), count = arrays.count;
  const double* in[kIn];
  double* out[kOut];
  for (std::size_t j = 0; j < kIn; ++j) in[j] = arrays.in[j];
  for (std::size_t j = 0; j < kOut; ++j) out[j] = arrays.out[j];
  // One more output than is kept: without a gradient the kernels still form a pointer behind the value.
  V64 x[kIn], y[kOut + 1];
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    for (std::size_t j = 0; j < kIn; ++j) x[j] = hn::LoadU(d, in[j] + i);
    Kernel::Evaluate(p, x, y);
    for (std::size_t j = 0; j < kOut; ++j) hn::StoreU(y[j], d, out[j] + i);
  }
  // The last samples, fewer than a vector: padded with a harmless direction.
  if (i == count) return;
  double pad[hn::MaxLanes(D64())];
  for (std::size_t j = 0; j < kIn; ++j) {
    for (std::size_t k = 0; k < lanes; ++k) pad[k] = i + k < count ? in[j][i + k] : (j % 3 == 2 ? 1.0 : 0.0);
    x[j] = hn::LoadU(d, pad);
  }
  Kernel::Evaluate(p, x, y);
  for (std::size_t j = 0; j < kOut; ++j) {
    hn::StoreU(y[j], d, pad);
    for (std::size_t k = 0; i + k < count; ++k) out[j][i + k] = pad[k];
  }
}

template <bool kGradient>
void LobeLoop(const GgxArrays& arrays, Masking masking) {
  switch (masking) {
    case Masking::kSmithUnclamped:
      return Loop<LobeKernel<kGradient, Masking::kSmithUnclamped>>(arrays);
    case Masking::kSmithHeight:
      return Loop<LobeKernel<kGradient, Masking::kSmithHeight>>(arrays);
    default:
      return Loop<LobeKernel<kGradient, Masking::kSmithSeparable>>(arrays);
  }
}

void LobeArrays(const GgxArrays& arrays, int masking, bool gradient) {
  gradient ? LobeLoop<true>(arrays, static_cast<Masking>(masking))
           : LobeLoop<false>(arrays, static_cast<Masking>(masking));
}

void DistributionArrays(const GgxArrays& arrays, bool gradient) {
  gradient ? Loop<DistributionKernel<true>>(arrays) : Loop<DistributionKernel<false>>(arrays);
}

void MaskingArrays(const GgxArrays& arrays, bool clamp, bool gradient) {
  if (clamp) {
    gradient ? Loop<MaskingKernel<true, true>>(arrays) : Loop<MaskingKernel<false, true>>(arrays);
  } else {
    gradient ? Loop<MaskingKernel<true, false>>(arrays) : Loop<MaskingKernel<false, false>>(arrays);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lobefit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobefit {
namespace {

namespace scalar {

double Root(double x) { return std::sqrt(x); }
double Constant(double /*like*/, double value) { return value; }
double SelectNegative(double x, double yes, double no) { return x < 0.0 ? yes : no; }

#include "lobefit/core/brdf/ggx_lobe-inl.h"

}  // namespace scalar

scalar::GgxLobeUniform<double> Uniform(const SlopeCoordinates& shape) {
  const double a = std::exp(shape.v[2]), c = std::exp(shape.v[4]);
  return {shape.v[0], shape.v[1], a, shape.v[3], c, 1 / a, 1 / c, 0.25 * kInvPi / (a * c)};
}

HWY_EXPORT(LobeArrays);
HWY_EXPORT(DistributionArrays);
HWY_EXPORT(MaskingArrays);

// The uniform as the targets take it.
struct Packed {
  explicit Packed(const SlopeCoordinates& shape) {
    const scalar::GgxLobeUniform<double> p = Uniform(shape);
    const double all[8] = {p.slope_x, p.slope_y, p.a, p.b, p.c, p.inv_a, p.inv_c, p.quarter_inv_pi_det};
    std::copy(all, all + 8, values);
  }
  double values[8];
};

}  // namespace

void GgxLobe(const DirectionArrays& directions, const SlopeCoordinates& shape, Masking masking, double* specular,
             double* cos_d, double* gradient) {
  const Packed uniform(shape);
  const DirectionArrays& from = directions;
  const double* in[6] = {from.wi_x, from.wi_y, from.wi_z, from.wo_x, from.wo_y, from.wo_z};
  double* out[7] = {specular, cos_d};
  for (std::size_t j = 0; gradient != nullptr && j < 5; ++j) out[2 + j] = gradient + j * from.count;
  HWY_DYNAMIC_DISPATCH(LobeArrays)
  ({uniform.values, in, out, from.count}, static_cast<int>(masking), gradient != nullptr);
}

void GgxD(const VectorArrays& wm, const SlopeCoordinates& shape, double* D, double* gradient) {
  const Packed uniform(shape);
  const double* in[3] = {wm.x, wm.y, wm.z};
  double* out[6] = {D};
  for (std::size_t j = 0; gradient != nullptr && j < 5; ++j) out[1 + j] = gradient + j * wm.count;
  HWY_DYNAMIC_DISPATCH(DistributionArrays)({uniform.values, in, out, wm.count}, gradient != nullptr);
}

void GgxG1(const VectorArrays& u, const SlopeCoordinates& shape, bool clamp, double* G1, double* gradient) {
  const Packed uniform(shape);
  const double* in[3] = {u.x, u.y, u.z};
  double* out[6] = {G1};
  for (std::size_t j = 0; gradient != nullptr && j < 5; ++j) out[1 + j] = gradient + j * u.count;
  HWY_DYNAMIC_DISPATCH(MaskingArrays)({uniform.values, in, out, u.count}, clamp, gradient != nullptr);
}

double GgxD(const Vec3& wm, const SlopeCoordinates& shape, double gradient[5]) {
  const scalar::GgxLobeUniform<double> p = Uniform(shape);
  return gradient != nullptr ? scalar::GgxDistribution<true>(p, wm.x, wm.y, wm.z, gradient)
                             : scalar::GgxDistribution<false>(p, wm.x, wm.y, wm.z, gradient);
}

double GgxG1(const Vec3& u, const SlopeCoordinates& shape, bool clamp, double gradient[5]) {
  const scalar::GgxLobeUniform<double> p = Uniform(shape);
  const auto evaluate = [&]<bool kGradient, bool kClamp>() {
    return scalar::GgxMaskingG1<kGradient, kClamp>(p, u.x, u.y, u.z, gradient);
  };
  if (gradient != nullptr) return clamp ? evaluate.operator()<true, true>() : evaluate.operator()<true, false>();
  return clamp ? evaluate.operator()<false, true>() : evaluate.operator()<false, false>();
}

double GgxLobe(const Vec3& wi, const Vec3& wo, const SlopeCoordinates& shape, Masking masking, double* cos_d,
               double gradient[5]) {
  const scalar::GgxLobeUniform<double> p = Uniform(shape);
  const auto evaluate = [&]<bool kGradient, Masking kMasking>() {
    return scalar::GgxSpecular<kGradient, kMasking>(p, wi.x, wi.y, wi.z, wo.x, wo.y, wo.z, cos_d, gradient);
  };
  const bool g = gradient != nullptr;
  switch (masking) {
    case Masking::kSmithUnclamped:
      return g ? evaluate.operator()<true, Masking::kSmithUnclamped>()
               : evaluate.operator()<false, Masking::kSmithUnclamped>();
    case Masking::kSmithHeight:
      return g ? evaluate.operator()<true, Masking::kSmithHeight>()
               : evaluate.operator()<false, Masking::kSmithHeight>();
    default:
      break;
  }
  return g ? evaluate.operator()<true, Masking::kSmithSeparable>()
           : evaluate.operator()<false, Masking::kSmithSeparable>();
}

}  // namespace lobefit
#endif  // HWY_ONCE
