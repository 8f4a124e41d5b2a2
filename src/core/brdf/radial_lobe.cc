#include "lobefit/core/brdf/radial_lobe.h"

#include <algorithm>
#include <cmath>
#include <vector>

#ifndef LOBEFIT_CORE_RADIAL_PIECE
#define LOBEFIT_CORE_RADIAL_PIECE
namespace lobefit {
inline constexpr std::size_t kRadialPiece = 64;

// One piece of the samples: its arrays, and what is common to all pieces. Where samples are read the arrays hold whole
// vectors.
struct RadialPiece {
  double direction[6][kRadialPiece];
  double specular[kRadialPiece], cos_d[kRadialPiece], by_shape[5][kRadialPiece];
  double a[2][kRadialPiece];                                   // c / sqrt(q) of wi and wo
  double difference[2][kRadialPiece], slope[2][kRadialPiece];  // of the table there
  // Of the gradient by q: factors of the table's derivatives, place in the spline.
  double by_table[2][kRadialPiece], x[kRadialPiece], interval[kRadialPiece];
  double uniform[8];  // GgxLobeUniform
  double scale;       // pi / Z
  const Profile* profile;
};
}  // namespace lobefit
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "radial_lobe.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After highway.h.
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace lobefit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D64 = hn::CappedTag<double, 8>;
using V64 = hn::Vec<D64>;

HWY_INLINE V64 Root(V64 x) { return hn::Sqrt(x); }
HWY_INLINE V64 Constant(V64 /*like*/, double value) { return hn::Set(D64(), value); }
HWY_INLINE V64 SelectNegative(V64 x, V64 yes, V64 no) { return hn::IfThenElse(hn::Lt(x, hn::Zero(D64())), yes, no); }

#include "lobefit/core/brdf/ggx_lobe-inl.h"

HWY_INLINE V64 Load(const double* p) { return hn::LoadU(D64(), p); }
HWY_INLINE V64 Number(double x) { return hn::Set(D64(), x); }
HWY_INLINE GgxLobeUniform<V64> UniformOf(const RadialPiece& piece) {
  const double* u = piece.uniform;
  return {Number(u[0]), Number(u[1]), Number(u[2]), Number(u[3]),
          Number(u[4]), Number(u[5]), Number(u[6]), Number(u[7])};
}

HWY_INLINE V64 AlongMean(const GgxLobeUniform<V64>& p, V64 ux, V64 uy, V64 uz) {
  return uz - p.slope_x * ux - p.slope_y * uy;
}

// Where the table is asked: infinite where u is the normal, no difference.
void FindPlaces(RadialPiece* piece) {
  const GgxLobeUniform<V64> p = UniformOf(*piece);
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t i = 0; i < kRadialPiece; i += hn::Lanes(D64())) {
      const V64 ux = Load(piece->direction[3 * side] + i), uy = Load(piece->direction[3 * side + 1] + i);
      const V64 c = AlongMean(p, ux, uy, Load(piece->direction[3 * side + 2] + i));
      const V64 q1 = p.a * ux + p.b * uy, q2 = p.c * uy;
      hn::StoreU(hn::Abs(c) / hn::Sqrt(q1 * q1 + q2 * q2), D64(), piece->a[side] + i);
    }
  }
}

// X = over / under of one direction, max(sigma, cos) where clamped, and what its derivatives need.
struct RadialArea {
  GgxSigma<V64> sigma;
  V64 over, under, excess, root;
};

template <bool kClamp>
HWY_INLINE RadialArea AreaOf(const GgxLobeUniform<V64>& p, const RadialPiece& piece, std::size_t side, std::size_t i,
                             V64 ux, V64 uy, V64 uz) {
  RadialArea area;
  area.sigma = EvaluateSigma(p, ux, uy, uz);
  area.root = hn::Sqrt(area.sigma.q1 * area.sigma.q1 + area.sigma.q2 * area.sigma.q2);
  area.over = area.sigma.over + area.sigma.under * (area.root * Load(piece.difference[side] + i));
  area.under = area.sigma.under;
  area.excess = area.over - uz * area.under;
  if constexpr (kClamp) {
    area.over = SelectNegative(area.excess, uz, area.over);
    area.under = SelectNegative(area.excess, Number(1), area.under);
  }
  return area;
}

// Adds factor * d ln X to the gradient of ln specular: sigma = (c + s) / 2 + root difference(a), by c and, twice, by q.
template <bool kClamp>
HWY_INLINE void AddArea(const GgxLobeUniform<V64>& p, RadialPiece* piece, std::size_t side, std::size_t i,
                        const RadialArea& area, V64 ux, V64 uy, V64 uz, V64 factor, V64* gradient) {
  const V64 zero = Number(0), half = Number(0.5);
  if constexpr (kClamp) factor = SelectNegative(area.excess, zero, factor);
  const V64 difference = Load(piece->difference[side] + i), slope = Load(piece->slope[side] + i),
            a = Load(piece->a[side] + i);
  const V64 inverse = factor * area.under / area.over;
  const V64 ggx = Number(2) * area.sigma.over / area.sigma.under;  // c + s
  const V64 c = AlongMean(p, ux, uy, uz);
  const V64 f = inverse * (half * ggx / area.sigma.s + SelectNegative(c, zero - slope, slope));
  const V64 by_root = hn::IfThenElse(hn::Gt(area.root, zero), (difference - a * slope) / area.root, zero);
  const V64 g = inverse * (half / area.sigma.s + by_root);
  gradient[0] = gradient[0] - f * ux;
  gradient[1] = gradient[1] - f * uy;
  gradient[2] = gradient[2] + g * area.sigma.q1 * p.a * ux;
  gradient[3] = gradient[3] + g * area.sigma.q1 * uy;
  gradient[4] = gradient[4] + g * area.sigma.q2 * area.sigma.q2;
  hn::StoreU(inverse * area.root, D64(), piece->by_table[side] + i);
}

// E(u) and the local exponent g(u) of profile.h.
HWY_INLINE V64 ExcessOf(RadialPiece* piece, std::size_t i, V64 u, V64* g) {
  const ProfileSpline& spline = piece->profile->spline();
  const double* c = piece->profile->Cubic(0);
  V64 left = Number(0), c0 = Number(c[0]), c1 = Number(c[1]), c2 = Number(c[2]), c3 = Number(c[3]), at = Number(0);
  for (std::size_t k = 1; k < spline.intervals(); ++k) {
    c = piece->profile->Cubic(k);
    const V64 from = Number(spline.Left(k));
    const auto beyond = hn::Ge(u, from);
    left = hn::IfThenElse(beyond, from, left);
    c0 = hn::IfThenElse(beyond, Number(c[0]), c0);
    c1 = hn::IfThenElse(beyond, Number(c[1]), c1);
    c2 = hn::IfThenElse(beyond, Number(c[2]), c2);
    c3 = hn::IfThenElse(beyond, Number(c[3]), c3);
    at = hn::IfThenElse(beyond, Number(static_cast<double>(k)), at);
  }
  const V64 x = u - left;
  hn::StoreU(x, D64(), piece->x + i);
  hn::StoreU(at, D64(), piece->interval + i);
  *g = Number(2) - (c1 + x * (Number(2) * c2 + x * (Number(3) * c3)));
  return c0 + x * (c1 + x * (c2 + x * c3));
}

// The operations and their order are those of GgxSpecular, so that a profile of coefficients 0 is GGX to the bit.
template <bool kGradient, Masking kMasking>
void Piece(RadialPiece* piece) {
  constexpr bool kClamp = kMasking != Masking::kSmithUnclamped;
  const D64 d;
  const GgxLobeUniform<V64> p = UniformOf(*piece);
  const V64 zero = Number(0), one = Number(1);
  for (std::size_t n = 0; n < kRadialPiece; n += hn::Lanes(d)) {
    const V64 ix = Load(piece->direction[0] + n), iy = Load(piece->direction[1] + n),
              iz = Load(piece->direction[2] + n), ox = Load(piece->direction[3] + n),
              oy = Load(piece->direction[4] + n), oz = Load(piece->direction[5] + n);
    const V64 hx = ix + ox, hy = iy + oy, hz = iz + oz, h2 = hx * hx + hy * hy + hz * hz;
    hn::StoreU(Number(0.5) * hn::Sqrt(h2), d, piece->cos_d + n);
    const V64 y1 = (zero - hx - p.slope_x * hz) * p.inv_a, y2 = (zero - hy - p.slope_y * hz - p.b * y1) * p.inv_c;
    const V64 k = hz * hz + y1 * y1 + y2 * y2;
    const RadialArea in = AreaOf<kClamp>(p, *piece, 0, n, ix, iy, iz),
                     out = AreaOf<kClamp>(p, *piece, 1, n, ox, oy, oz);
    V64 both = in.over * out.over;
    if constexpr (kMasking == Masking::kSmithHeight)
      both = in.over * out.under * oz + (out.over - oz * out.under) * in.under * iz;
    const V64 inverse = one / (k * k * both);
    const V64 ggx = p.quarter_inv_pi_det * (h2 * h2) * (in.under * out.under) * inverse;
    V64 g;
    const V64 excess = ExcessOf(piece, n, hn::Log(d, k / (hz * hz)), &g);
    const V64 specular = ggx * (hn::Exp(d, excess) * Number(piece->scale));
    hn::StoreU(specular, d, piece->specular + n);
    if constexpr (kGradient) {
      const V64 z2 = y2 * p.inv_c, z1 = (y1 - p.b * z2) * p.inv_a, slope = Number(2) * g / k;
      V64 gradient[5] = {slope * z1 * hz, slope * z2 * hz, slope * p.a * z1 * y1 - one, slope * z2 * y1,
                         slope * p.c * z2 * y2 - one};
      V64 factor_i = zero - one, factor_o = zero - one;
      if constexpr (kMasking == Masking::kSmithHeight) {
        factor_i = (zero - in.over) * out.under * oz / both;
        factor_o = (zero - out.over) * in.under * iz / both;
      }
      AddArea<kClamp>(p, piece, 0, n, in, ix, iy, iz, factor_i, gradient);
      AddArea<kClamp>(p, piece, 1, n, out, ox, oy, oz, factor_o, gradient);
      for (std::size_t j = 0; j < 5; ++j) hn::StoreU(gradient[j] * specular, d, piece->by_shape[j] + n);
    }
  }
}

void EvaluatePiece(RadialPiece* piece, int masking, bool gradient) {
  switch (static_cast<Masking>(masking)) {
    case Masking::kSmithUnclamped:
      return gradient ? Piece<true, Masking::kSmithUnclamped>(piece) : Piece<false, Masking::kSmithUnclamped>(piece);
    case Masking::kSmithHeight:
      return gradient ? Piece<true, Masking::kSmithHeight>(piece) : Piece<false, Masking::kSmithHeight>(piece);
    default:
      return gradient ? Piece<true, Masking::kSmithSeparable>(piece) : Piece<false, Masking::kSmithSeparable>(piece);
  }
}

// gradient[k * count + i] = d specular / dq_k, sample by sample across the coefficients. `tables`: the differences of
// wi and wo, `stride` apart; `less`: d ln Z / dq, as long.
void ByCoefficients(const RadialPiece& piece, const double* const* tables, std::size_t stride, const double* less,
                    std::size_t size, std::size_t count, double* gradient) {
  const hn::CappedTag<double, 4> d;
  const ProfileSpline& spline = piece.profile->spline();
  const std::size_t K = spline.size();
  double row[32];
  for (std::size_t i = 0; i < size; ++i) {
    const double* c = spline.Coefficients(static_cast<std::size_t>(piece.interval[i]));
    const double *in = tables[0] + i * stride + 1, *out = tables[1] + i * stride + 1;
    const auto x = hn::Set(d, piece.x[i]), f = hn::Set(d, piece.by_table[0][i]), g = hn::Set(d, piece.by_table[1][i]),
               specular = hn::Set(d, piece.specular[i]);
    for (std::size_t k = 0; k < K; k += hn::Lanes(d)) {
      const auto basis =
          hn::LoadU(d, c + k) +
          x * (hn::LoadU(d, c + K + k) + x * (hn::LoadU(d, c + 2 * K + k) + x * hn::LoadU(d, c + 3 * K + k)));
      const auto sum = basis - hn::LoadU(d, less + k) + f * hn::LoadU(d, in + k) + g * hn::LoadU(d, out + k);
      hn::StoreU(sum * specular, d, row + k);
    }
    for (std::size_t k = 0; k < K; ++k) gradient[k * count + i] = row[k];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lobefit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobefit {
HWY_EXPORT(FindPlaces);
HWY_EXPORT(EvaluatePiece);
HWY_EXPORT(ByCoefficients);

void RadialLobe(const DirectionArrays& d, const SlopeCoordinates& shape, const ProfileMasking& profile, Masking masking,
                double* specular, double* cos_d, double* gradient) {
  const double a = std::exp(shape.v[2]), c = std::exp(shape.v[4]);
  const Profile& f = profile.profile();
  const std::size_t K = f.q().size(), stride = profile.stride();
  RadialPiece piece = {};
  const double uniform[8] = {shape.v[0], shape.v[1], a, shape.v[3], c, 1 / a, 1 / c, 0.25 * kInvPi / (a * c)};
  std::copy_n(uniform, 8, piece.uniform);
  piece.scale = 1.0 / (1.0 + f.mass_excess());
  piece.profile = &f;
  // Rows of the table's differences are read from their second number on, whole vectors.
  const std::size_t most = std::min(d.count, kRadialPiece);
  std::vector<double> memory(2 * (most * stride + 4) + K + 4, 0.0);
  double* const tables[2] = {memory.data(), memory.data() + most * stride + 4};
  double* const less = memory.data() + 2 * (most * stride + 4);
  std::copy(f.dlog_mass().begin(), f.dlog_mass().end(), less);
  const double* const from[6] = {d.wi_x, d.wi_y, d.wi_z, d.wo_x, d.wo_y, d.wo_z};
  for (std::size_t begin = 0; begin < d.count; begin += kRadialPiece) {
    const std::size_t size = std::min(kRadialPiece, d.count - begin);
    for (std::size_t k = 0; k < 6; ++k) {
      std::copy_n(from[k] + begin, size, piece.direction[k]);
      std::fill(piece.direction[k] + size, piece.direction[k] + kRadialPiece, k % 3 == 2 ? 1.0 : 0.0);
    }
    HWY_DYNAMIC_DISPATCH(FindPlaces)(&piece);
    for (std::size_t side = 0; side < 2; ++side) {
      profile.Differences(piece.a[side], size, gradient != nullptr ? piece.slope[side] : nullptr, tables[side]);
      for (std::size_t i = 0; i < size; ++i) piece.difference[side][i] = tables[side][i * stride];
    }
    HWY_DYNAMIC_DISPATCH(EvaluatePiece)(&piece, static_cast<int>(masking), gradient != nullptr);
    std::copy_n(piece.specular, size, specular + begin);
    std::copy_n(piece.cos_d, size, cos_d + begin);
    if (gradient == nullptr) continue;
    for (std::size_t j = 0; j < 5; ++j) std::copy_n(piece.by_shape[j], size, gradient + j * d.count + begin);
    HWY_DYNAMIC_DISPATCH(ByCoefficients)
    (piece, tables, stride, less, size, d.count, gradient + 5 * d.count + begin);
  }
}

}  // namespace lobefit
#endif  // HWY_ONCE
