#include "lobefit/core/radial/profile_table.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "profile_table.cc"
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
constexpr std::size_t kPiece = 64;

HWY_INLINE V64 Load(const double* p) { return hn::LoadU(D64(), p); }
HWY_INLINE V64 Constant(double x) { return hn::Set(D64(), x); }

// The node below each a, as a number.
void FindNodes(const std::vector<ProfileBreak>& breaks, const double* a, double* node) {
  const D64 d;
  for (std::size_t i = 0; i < kPiece; i += hn::Lanes(d)) {
    const V64 x = Load(a + i);
    const V64 position = hn::Log(d, x + hn::Sqrt(Constant(1) + x * x));  // asinh; its last bits do not matter
    V64 from = Constant(breaks[0].from), per_step = Constant(breaks[0].per_step),
        first = Constant(static_cast<double>(breaks[0].first)),
        last = Constant(static_cast<double>(breaks[0].steps - 1));
    for (std::size_t b = 1; b < breaks.size(); ++b) {
      const auto beyond = hn::Ge(position, Constant(breaks[b].from));
      from = hn::IfThenElse(beyond, Constant(breaks[b].from), from);
      per_step = hn::IfThenElse(beyond, Constant(breaks[b].per_step), per_step);
      first = hn::IfThenElse(beyond, Constant(static_cast<double>(breaks[b].first)), first);
      last = hn::IfThenElse(beyond, Constant(static_cast<double>(breaks[b].steps - 1)), last);
    }
    const V64 steps = hn::Floor(hn::Max(hn::Zero(d), (position - from) * per_step));
    hn::StoreU(first + hn::Min(steps, last), d, node + i);
  }
}

// Weights of value, -slope and curvature at both ends, for the value and for its derivative.
void FindWeights(const double* a, const double* from, const double* width, double (*value)[kPiece],
                 double (*derivative)[kPiece]) {
  const D64 d;
  const V64 one = Constant(1), half = Constant(0.5), two = Constant(2), three = Constant(3), six = Constant(6);
  for (std::size_t i = 0; i < kPiece; i += hn::Lanes(d)) {
    const V64 h = Load(width + i), x = (Load(a + i) - Load(from + i)) / h, y = one - x;
    const V64 xx = x * x, yy = y * y, x3 = xx * x, y3 = yy * y;
    hn::StoreU(y3 * (one + three * x + six * xx), d, value[0] + i);
    hn::StoreU(hn::Zero(d) - h * x * y3 * (one + three * x), d, value[1] + i);
    hn::StoreU(half * h * h * xx * y3, d, value[2] + i);
    hn::StoreU(x3 * (one + three * y + six * yy), d, value[3] + i);
    hn::StoreU(h * y * x3 * (one + three * y), d, value[4] + i);
    hn::StoreU(half * h * h * yy * x3, d, value[5] + i);
    if (derivative == nullptr) continue;
    const V64 in_m = Constant(30) * xx * yy / h, bend = half * h * x * y, five = Constant(5), more = Constant(15);
    hn::StoreU(hn::Zero(d) - in_m, d, derivative[0] + i);
    hn::StoreU(yy * (more * xx - one - two * x), d, derivative[1] + i);
    hn::StoreU(bend * y * (two - five * x), d, derivative[2] + i);
    hn::StoreU(in_m, d, derivative[3] + i);
    hn::StoreU(xx * (more * yy - one - two * y), d, derivative[4] + i);
    hn::StoreU(bend * x * (five * y - two), d, derivative[5] + i);
  }
}

void InterpolatePieces(const ProfileTable& table, const double* given, std::size_t count, double* slope,
                       double* difference) {
  const hn::CappedTag<double, 4> d;
  const std::size_t stride = table.stride;
  double a[kPiece], node[kPiece], from[kPiece], width[kPiece], value[6][kPiece], derivative[6][kPiece];
  for (std::size_t begin = 0; begin < count; begin += kPiece) {
    const std::size_t size = std::min(kPiece, count - begin);
    std::copy_n(given + begin, size, a);
    std::fill(a + size, a + kPiece, 0.0);
    FindNodes(*table.breaks, a, node);
    for (std::size_t i = 0; i < kPiece; ++i) {
      const double* at = table.nodes + static_cast<std::size_t>(node[i]);
      from[i] = at[0];
      width[i] = at[1] - at[0];
    }
    FindWeights(a, from, width, value, slope != nullptr ? derivative : nullptr);
    for (std::size_t i = 0; i < size; ++i) {
      const double* row = table.rows + static_cast<std::size_t>(node[i]) * 3 * stride;
      double* to = difference + (begin + i) * stride;
      if (slope == nullptr) {
        to[0] = value[0][i] * row[0] + value[1][i] * row[stride] + value[2][i] * row[2 * stride] +
                value[3][i] * row[3 * stride] + value[4][i] * row[4 * stride] + value[5][i] * row[5 * stride];
        continue;
      }
      slope[begin + i] = derivative[0][i] * row[0] + derivative[1][i] * row[stride] +
                         derivative[2][i] * row[2 * stride] + derivative[3][i] * row[3 * stride] +
                         derivative[4][i] * row[4 * stride] + derivative[5][i] * row[5 * stride];
      // Across the columns, which lie side by side.
      for (std::size_t k = 0; k < stride; k += hn::Lanes(d)) {
        auto sum = hn::Set(d, value[0][i]) * hn::LoadU(d, row + k);
        for (std::size_t r = 1; r < 6; ++r) sum = sum + hn::Set(d, value[r][i]) * hn::LoadU(d, row + r * stride + k);
        hn::StoreU(sum, d, to + k);
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lobefit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobefit {
HWY_EXPORT(InterpolatePieces);

void InterpolateProfile(const ProfileTable& table, const double* a, std::size_t count, double* slope,
                        double* difference) {
  HWY_DYNAMIC_DISPATCH(InterpolatePieces)(table, a, count, slope, difference);
}

}  // namespace lobefit
#endif  // HWY_ONCE
