#include "lobefit/core/radial/profile_moments.h"

#ifndef LOBEFIT_CORE_PROFILE_PIECE
#define LOBEFIT_CORE_PROFILE_PIECE
namespace lobefit {
// One piece of the points, and its sums: of the difference or of e^E, then of e^E x^j.
struct ProfilePiece {
  const double *x, *weights[3], *cubic;
  std::size_t count;
  double less;  // Z / pi - 1; NaN: without the difference
  double sums[3][5];
};
}  // namespace lobefit
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "profile_moments.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After highway.h.
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace lobefit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void SumPiece(ProfilePiece* piece) {
  const hn::CappedTag<double, 8> d;
  using V = hn::Vec<decltype(d)>;
  const V c0 = hn::Set(d, piece->cubic[0]), c1 = hn::Set(d, piece->cubic[1]), c2 = hn::Set(d, piece->cubic[2]),
          c3 = hn::Set(d, piece->cubic[3]), less = hn::Set(d, piece->less), most = hn::Set(d, 709.0);
  const bool minus = piece->less == piece->less;
  V sums[3][5];
  for (auto& row : sums) {
    for (V& sum : row) sum = hn::Zero(d);
  }
  for (std::size_t i = 0; i < piece->count; i += hn::Lanes(d)) {
    const V x = hn::LoadU(d, piece->x + i);
    const V excess = hn::Min(hn::MulAdd(hn::MulAdd(hn::MulAdd(c3, x, c2), x, c1), x, c0), most);
    const V f = hn::Exp(d, excess), fx = hn::Mul(f, x), fxx = hn::Mul(fx, x), fxxx = hn::Mul(fxx, x);
    const V value = minus ? hn::Sub(hn::Expm1(d, excess), less) : f;
    for (std::size_t m = 0; m < 3; ++m) {
      const V w = hn::LoadU(d, piece->weights[m] + i);
      sums[m][0] = hn::MulAdd(w, value, sums[m][0]);
      sums[m][1] = hn::MulAdd(w, f, sums[m][1]);
      sums[m][2] = hn::MulAdd(w, fx, sums[m][2]);
      sums[m][3] = hn::MulAdd(w, fxx, sums[m][3]);
      sums[m][4] = hn::MulAdd(w, fxxx, sums[m][4]);
    }
  }
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t j = 0; j < 5; ++j) piece->sums[m][j] = hn::GetLane(hn::SumOfLanes(d, sums[m][j]));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lobefit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cmath>
#include <limits>

namespace lobefit {
HWY_EXPORT(SumPiece);

namespace {
constexpr std::size_t kLanes = 8;  // the most of a vector
}

void ProfilePoints::Add(const ProfileSpline& spline, std::size_t interval, double u,
                        const std::array<double, 3>& weights) {
  if (pieces_.empty() || pieces_.back().interval != interval) {
    Pad();
    pieces_.push_back({interval, x_.size(), x_.size()});
  }
  x_.push_back(u - spline.Left(interval));
  for (std::size_t m = 0; m < 3; ++m) weights_[m].push_back(weights[m]);
}

void ProfilePoints::Pad() {
  if (pieces_.empty()) return;
  const std::size_t size = (x_.size() + kLanes - 1) / kLanes * kLanes;
  x_.resize(size, 0.0);
  for (std::vector<double>& of_moment : weights_) of_moment.resize(size, 0.0);
  pieces_.back().end = size;
}

void ProfilePoints::Finish() {
  Pad();
  x_.shrink_to_fit();
  for (std::vector<double>& of_moment : weights_) of_moment.shrink_to_fit();
}

void ProfilePoints::AddMoments(const Profile& profile, bool minus_ggx, double* moments, std::size_t stride) const {
  const std::size_t K = profile.q().size();
  for (const Piece& piece : pieces_) {
    ProfilePiece sums = {};
    sums.x = x_.data() + piece.begin;
    for (std::size_t m = 0; m < 3; ++m) sums.weights[m] = weights_[m].data() + piece.begin;
    sums.cubic = profile.Cubic(piece.interval);
    sums.count = piece.end - piece.begin;
    sums.less = minus_ggx ? profile.mass_excess() : std::numeric_limits<double>::quiet_NaN();
    HWY_DYNAMIC_DISPATCH(SumPiece)(&sums);
    const double* c = profile.spline().Coefficients(piece.interval);
    for (std::size_t m = 0; m < 3; ++m) {
      double* to = moments + m * stride;
      const double* s = sums.sums[m];
      to[0] += s[0];
      for (std::size_t k = 0; k < K; ++k)
        to[k + 1] += s[1] * c[k] + s[2] * c[K + k] + s[3] * c[2 * K + k] + s[4] * c[3 * K + k];
    }
  }
}

}  // namespace lobefit
#endif  // HWY_ONCE
