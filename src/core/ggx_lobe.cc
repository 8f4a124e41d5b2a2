#include "lobefit/core/ggx_lobe.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobefit/core/ggx_lobe.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lobefit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D64 = hn::ScalableTag<double>;
using V64 = hn::Vec<D64>;

HWY_INLINE V64 Root(V64 x) { return hn::Sqrt(x); }
HWY_INLINE V64 Larger(V64 a, V64 b) { return hn::Max(a, b); }
HWY_INLINE V64 Constant(V64 /*like*/, double value) { return hn::Set(D64(), value); }
HWY_INLINE V64 SelectNegative(V64 x, V64 yes, V64 no) { return hn::IfThenElse(hn::Lt(x, hn::Zero(D64())), yes, no); }

#include "lobefit/core/ggx_lobe-inl.h"

GgxLobeUniform<V64> Broadcast(const double* u) {
  const D64 d;
  return {hn::Set(d, u[0]), hn::Set(d, u[1]), hn::Set(d, u[2]), hn::Set(d, u[3]),
          hn::Set(d, u[4]), hn::Set(d, u[5]), hn::Set(d, u[6]), hn::Set(d, u[7])};
}

template <bool kGradient, GgxMasking kMasking>
void Loop(const DirectionArrays& in, const double* uniform, double* specular, double* cos_d, double* gradient) {
  const D64 d;
  const GgxLobeUniform<V64> p = Broadcast(uniform);
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  V64 cos, g[5];
  for (; i + lanes <= in.count; i += lanes) {
    const V64 value = GgxSpecular<kGradient, kMasking>(p, hn::LoadU(d, in.wi_x + i), hn::LoadU(d, in.wi_y + i),
                                                       hn::LoadU(d, in.wi_z + i), hn::LoadU(d, in.wo_x + i),
                                                       hn::LoadU(d, in.wo_y + i), hn::LoadU(d, in.wo_z + i), &cos, g);
    hn::StoreU(value, d, specular + i);
    hn::StoreU(cos, d, cos_d + i);
    if constexpr (kGradient) {
      for (std::size_t j = 0; j < 5; ++j) hn::StoreU(g[j], d, gradient + j * in.count + i);
    }
  }
  // The last samples, fewer than a vector: padded with a harmless direction.
  if (i == in.count) return;
  constexpr std::size_t kMaxLanes = hn::MaxLanes(D64());
  double pad[6][kMaxLanes], out[7][kMaxLanes];
  const double* from[6] = {in.wi_x, in.wi_y, in.wi_z, in.wo_x, in.wo_y, in.wo_z};
  for (std::size_t j = 0; j < 6; ++j) {
    for (std::size_t k = 0; k < lanes; ++k) pad[j][k] = i + k < in.count ? from[j][i + k] : (j % 3 == 2 ? 1.0 : 0.0);
  }
  const V64 value =
      GgxSpecular<kGradient, kMasking>(p, hn::LoadU(d, pad[0]), hn::LoadU(d, pad[1]), hn::LoadU(d, pad[2]),
                                       hn::LoadU(d, pad[3]), hn::LoadU(d, pad[4]), hn::LoadU(d, pad[5]), &cos, g);
  hn::StoreU(value, d, out[0]);
  hn::StoreU(cos, d, out[1]);
  if constexpr (kGradient) {
    for (std::size_t j = 0; j < 5; ++j) hn::StoreU(g[j], d, out[2 + j]);
  }
  for (std::size_t k = 0; i + k < in.count; ++k) {
    specular[i + k] = out[0][k];
    cos_d[i + k] = out[1][k];
    if constexpr (kGradient) {
      for (std::size_t j = 0; j < 5; ++j) gradient[j * in.count + i + k] = out[2 + j][k];
    }
  }
}

template <GgxMasking kMasking>
void WithMasking(const DirectionArrays& in, const double* uniform, double* specular, double* cos_d, double* gradient) {
  if (gradient != nullptr) {
    Loop<true, kMasking>(in, uniform, specular, cos_d, gradient);
  } else {
    Loop<false, kMasking>(in, uniform, specular, cos_d, nullptr);
  }
}

void GgxLobeArrays(const DirectionArrays& in, const double* uniform, int masking, double* specular, double* cos_d,
                   double* gradient) {
  switch (static_cast<Masking>(masking)) {
    case Masking::kSmithSeparable:
      return WithMasking<GgxMasking::kClamped>(in, uniform, specular, cos_d, gradient);
    case Masking::kSmithUnclamped:
      return WithMasking<GgxMasking::kUnclamped>(in, uniform, specular, cos_d, gradient);
    case Masking::kSmithHeight:
      return WithMasking<GgxMasking::kHeight>(in, uniform, specular, cos_d, gradient);
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
// The comparison of the vector instruction: the second operand where either is not a number.
double Larger(double a, double b) { return a > b ? a : b; }
double Constant(double /*like*/, double value) { return value; }
double SelectNegative(double x, double yes, double no) { return x < 0.0 ? yes : no; }

#include "lobefit/core/ggx_lobe-inl.h"

}  // namespace scalar

scalar::GgxLobeUniform<double> Uniform(const SlopeCoordinates& shape) {
  const double a = std::exp(shape.v[2]), c = std::exp(shape.v[4]);
  return {shape.v[0], shape.v[1], a, shape.v[3], c, 1 / a, 1 / c, 0.25 * kInvPi / (a * c)};
}

HWY_EXPORT(GgxLobeArrays);

}  // namespace

void GgxLobe(const DirectionArrays& directions, const SlopeCoordinates& shape, Masking masking, double* specular,
             double* cos_d, double* gradient) {
  const scalar::GgxLobeUniform<double> p = Uniform(shape);
  const double uniform[8] = {p.slope_x, p.slope_y, p.a, p.b, p.c, p.inv_a, p.inv_c, p.quarter_inv_pi_det};
  HWY_DYNAMIC_DISPATCH(GgxLobeArrays)(directions, uniform, static_cast<int>(masking), specular, cos_d, gradient);
}

double GgxLobe(const Vec3& wi, const Vec3& wo, const SlopeCoordinates& shape, Masking masking, double* cos_d,
               double gradient[5]) {
  using scalar::GgxMasking;
  const scalar::GgxLobeUniform<double> p = Uniform(shape);
  const auto evaluate = [&]<bool kGradient, GgxMasking kMasking>() {
    return scalar::GgxSpecular<kGradient, kMasking>(p, wi.x, wi.y, wi.z, wo.x, wo.y, wo.z, cos_d, gradient);
  };
  const bool g = gradient != nullptr;
  switch (masking) {
    case Masking::kSmithUnclamped:
      return g ? evaluate.operator()<true, GgxMasking::kUnclamped>()
               : evaluate.operator()<false, GgxMasking::kUnclamped>();
    case Masking::kSmithHeight:
      return g ? evaluate.operator()<true, GgxMasking::kHeight>() : evaluate.operator()<false, GgxMasking::kHeight>();
    case Masking::kSmithSeparable:
      break;
  }
  return g ? evaluate.operator()<true, GgxMasking::kClamped>() : evaluate.operator()<false, GgxMasking::kClamped>();
}

}  // namespace lobefit
#endif  // HWY_ONCE
