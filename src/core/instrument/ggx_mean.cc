#include "lobefit/core/instrument/ggx_mean.h"

#include <algorithm>
#include <cmath>

#ifndef LOBEFIT_CORE_GGX_MEAN_ARRAYS
#define LOBEFIT_CORE_GGX_MEAN_ARRAYS
namespace lobefit {
// Pointers of one call, the same for every target: inputs wi, wo; outputs specular, argument, their gradients.
struct GgxMeanArrays {
  const double* uniform;
  const double* in[6];
  double* out[12];
  std::size_t count;
  const GgxMeanRule* rule;
};
}  // namespace lobefit
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ggx_mean.cc"
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
HWY_INLINE bool AnyNegative(V64 x) { return !hn::AllFalse(D64(), hn::Lt(x, hn::Zero(D64()))); }

#include "lobefit/core/brdf/ggx_lobe-inl.h"
#include "lobefit/core/instrument/ggx_mean-inl.h"

template <bool kGradient, Masking kMasking>
void Loop(const GgxMeanArrays& arrays) {
  constexpr std::size_t kOut = kGradient ? 12 : 2;
  const D64 d;
  const double* u = arrays.uniform;
  const GgxLobeUniform<V64> p = {hn::Set(d, u[0]), hn::Set(d, u[1]), hn::Set(d, u[2]), hn::Set(d, u[3]),
                                 hn::Set(d, u[4]), hn::Set(d, u[5]), hn::Set(d, u[6]), hn::Set(d, u[7])};
  const std::size_t lanes = hn::Lanes(d), count = arrays.count;
  V64 x[6], y[12];
  const auto evaluate = [&] {
    y[0] =
        MeanSpecular<kGradient, kMasking>(p, *arrays.rule, {x[0], x[1], x[2]}, {x[3], x[4], x[5]}, &y[1], y + 2, y + 7);
  };
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    for (std::size_t j = 0; j < 6; ++j) x[j] = hn::LoadU(d, arrays.in[j] + i);
    evaluate();
    for (std::size_t j = 0; j < kOut; ++j) hn::StoreU(y[j], d, arrays.out[j] + i);
  }
  if (i == count) return;
  // The last samples, fewer than a vector: padded with a harmless direction.
  double pad[hn::MaxLanes(D64())];
  for (std::size_t j = 0; j < 6; ++j) {
    for (std::size_t k = 0; k < lanes; ++k) pad[k] = i + k < count ? arrays.in[j][i + k] : (j % 3 == 2 ? 1.0 : 0.0);
    x[j] = hn::LoadU(d, pad);
  }
  evaluate();
  for (std::size_t j = 0; j < kOut; ++j) {
    hn::StoreU(y[j], d, pad);
    for (std::size_t k = 0; i + k < count; ++k) arrays.out[j][i + k] = pad[k];
  }
}

template <bool kGradient>
void MeanLoop(const GgxMeanArrays& arrays, Masking masking) {
  switch (masking) {
    case Masking::kSmithUnclamped:
      return Loop<kGradient, Masking::kSmithUnclamped>(arrays);
    case Masking::kSmithHeight:
      return Loop<kGradient, Masking::kSmithHeight>(arrays);
    default:
      return Loop<kGradient, Masking::kSmithSeparable>(arrays);
  }
}

void MeanArrays(const GgxMeanArrays& arrays, int masking, bool gradient) {
  gradient ? MeanLoop<true>(arrays, static_cast<Masking>(masking))
           : MeanLoop<false>(arrays, static_cast<Masking>(masking));
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
bool AnyNegative(double x) { return x < 0.0; }

#include "lobefit/core/brdf/ggx_lobe-inl.h"
#include "lobefit/core/instrument/ggx_mean-inl.h"

}  // namespace scalar

scalar::GgxLobeUniform<double> Uniform(const SlopeCoordinates& shape) {
  const double a = std::exp(shape.v[2]), c = std::exp(shape.v[4]);
  return {shape.v[0], shape.v[1], a, shape.v[3], c, 1 / a, 1 / c, 0.25 * kInvPi / (a * c)};
}

HWY_EXPORT(MeanArrays);

}  // namespace

GgxMeanRule MakeGgxMeanRule(const Aperture& aperture, int nodes, FresnelArgument argument) {
  GgxMeanRule rule;
  for (const DiscNode& node : DiscNodes(aperture, std::min(nodes, GgxMeanRule::kMostNodes))) {
    rule.tau[rule.nodes] = node.tau;
    rule.weight[rule.nodes++] = node.weight;
  }
  rule.detector_share = DetectorShare(aperture);
  const double chord = std::sqrt(2 * (DiscTau(aperture.source) + DiscTau(aperture.detector)));
  for (std::size_t k = 0; k < GgxMeanRule::kPoints; ++k) {
    const DiscPoint& point = SevenDiscPoints()[k];
    SetDiscMultiples(point, rule.detector_share * chord, rule.points[k].o);
    SetDiscMultiples(point, (1 - rule.detector_share) * chord, rule.points[k].i);
    rule.points[k].weight = point.weight;
  }
  rule.flux = aperture.mean == ApertureMean::kFlux;
  rule.inverse_cosines = 1 / ((1 - 0.5 * DiscTau(aperture.source)) * (1 - 0.5 * DiscTau(aperture.detector)));
  rule.argument_is_cosine = argument == FresnelArgument::kCosine;
  return rule;
}

void GgxMeanLobe(const DirectionArrays& directions, const SlopeCoordinates& shape, Masking masking,
                 const GgxMeanRule& rule, const LobeMeans& means) {
  const scalar::GgxLobeUniform<double> p = Uniform(shape);
  const double uniform[8] = {p.slope_x, p.slope_y, p.a, p.b, p.c, p.inv_a, p.inv_c, p.quarter_inv_pi_det};
  const DirectionArrays& from = directions;
  GgxMeanArrays arrays = {uniform,
                          {from.wi_x, from.wi_y, from.wi_z, from.wo_x, from.wo_y, from.wo_z},
                          {means.specular, means.argument},
                          from.count,
                          &rule};
  const bool gradient = means.gradient != nullptr;
  for (std::size_t j = 0; gradient && j < 5; ++j) {
    arrays.out[2 + j] = means.gradient + j * from.count;
    arrays.out[7 + j] = means.argument_gradient + j * from.count;
  }
  HWY_DYNAMIC_DISPATCH(MeanArrays)(arrays, static_cast<int>(masking), gradient);
}

double GgxMeanLobe(const Vec3& wi, const Vec3& wo, const SlopeCoordinates& shape, Masking masking,
                   const GgxMeanRule& rule, double* argument, double gradient[5], double argument_gradient[5]) {
  const scalar::GgxLobeUniform<double> p = Uniform(shape);
  const auto evaluate = [&]<bool kGradient, Masking kMasking>() {
    return scalar::MeanSpecular<kGradient, kMasking, double>(p, rule, {wi.x, wi.y, wi.z}, {wo.x, wo.y, wo.z}, argument,
                                                             gradient, argument_gradient);
  };
  const auto with_masking = [&]<bool kGradient>() {
    switch (masking) {
      case Masking::kSmithUnclamped:
        return evaluate.template operator()<kGradient, Masking::kSmithUnclamped>();
      case Masking::kSmithHeight:
        return evaluate.template operator()<kGradient, Masking::kSmithHeight>();
      default:
        return evaluate.template operator()<kGradient, Masking::kSmithSeparable>();
    }
  };
  return gradient != nullptr ? with_masking.operator()<true>() : with_masking.operator()<false>();
}

double GgxMeanD(const Vec3& wi, const Vec3& wo, const SlopeCoordinates& shape, const GgxMeanRule& rule,
                double gradient[5]) {
  using Vector = scalar::GgxVector<double>;
  const scalar::GgxLobeUniform<double> p = Uniform(shape);
  const Vector i = {wi.x, wi.y, wi.z}, o = {wo.x, wo.y, wo.z};
  const auto frame = scalar::FrameOfPair(i, o);
  return gradient != nullptr ? scalar::MeanDistribution<true>(p, rule, frame, i, o, gradient)
                             : scalar::MeanDistribution<false>(p, rule, frame, i, o, gradient);
}

}  // namespace lobefit
#endif  // HWY_ONCE
