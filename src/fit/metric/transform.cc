#include "lobefit/fit/metric/transform.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transform.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After highway.h:
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace lobefit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D64 = hn::ScalableTag<double>;
using V64 = hn::Vec<D64>;

HWY_INLINE V64 Load(const double* p) { return hn::LoadU(D64(), p); }
HWY_INLINE V64 Constant(double x) { return hn::Set(D64(), x); }

constexpr double kMost = std::numeric_limits<double>::max(), kInfinity = std::numeric_limits<double>::infinity();

// A third of the exponent (through the upper half of the bits as a number) is within 6 %, two steps of Halley's method
// and one of Newton's leave rounding. A quarter of the time of exp(log(x) / 3). What would leave the range in a step is
// brought to the middle of it first, by powers of 2^3.
HWY_INLINE V64 CubeRoot(V64 x) {
  const D64 d;
  const hn::RebindToUnsigned<D64> bits;
  const V64 given = hn::Abs(x);
  const auto small = hn::Lt(given, Constant(1e-280)), large = hn::Gt(given, Constant(1e280));
  const V64 scale = hn::IfThenElse(small, Constant(0x1p+108), hn::IfThenElse(large, Constant(0x1p-108), Constant(1)));
  const V64 unscale = hn::IfThenElse(small, Constant(0x1p-36), hn::IfThenElse(large, Constant(0x1p+36), Constant(1)));
  const V64 magnitude = hn::Mul(given, scale), twice = hn::Add(magnitude, magnitude);
  // 2^52 + n holds the integer n in its lowest bits.
  const V64 shift = Constant(4503599627370496.0);
  const V64 upper = hn::Sub(
      hn::BitCast(d, hn::Or(hn::ShiftRight<32>(hn::BitCast(bits, magnitude)), hn::BitCast(bits, shift))), shift);
  // 715094163 = (2 / 3 of the exponent's bias, less 0.045) in units of the upper half.
  const V64 third = hn::Add(hn::MulAdd(upper, Constant(1.0 / 3), Constant(715094163.0)), shift);
  V64 y = hn::BitCast(d, hn::ShiftLeft<32>(hn::BitCast(bits, third)));
  for (int step = 0; step < 2; ++step) {
    const V64 cube = hn::Mul(hn::Mul(y, y), y);
    // The quotient first: y * (cube + twice) leaves the range where the root does not.
    y = hn::Mul(y, hn::Div(hn::Add(cube, twice), hn::Add(hn::Add(cube, cube), magnitude)));
  }
  const V64 y2 = hn::Mul(y, y);
  y = hn::Sub(y, hn::Div(hn::Sub(hn::Mul(y2, y), magnitude), hn::Mul(Constant(3), y2)));
  const auto ordinary = hn::And(hn::Gt(given, hn::Zero(d)), hn::Le(given, Constant(kMost)));
  return hn::IfThenElse(ordinary, hn::CopySign(hn::Mul(y, unscale), x), x);  // else 0, infinity or NaN
}

// ln(1 + v) as ln(u) + what rounding took from u = 1 + v.
HWY_INLINE V64 LogOnePlus(V64 v) {
  const D64 d;
  const V64 one = Constant(1), zero = hn::Zero(d), u = hn::Add(one, v);
  const V64 value = hn::Add(hn::Log(d, u), hn::Div(hn::Sub(v, hn::Sub(u, one)), u));
  const V64 special =
      hn::IfThenElse(hn::Eq(u, zero), Constant(-kInfinity),
                     hn::IfThenElse(hn::Lt(u, zero), Constant(std::numeric_limits<double>::quiet_NaN()), v));
  return hn::IfThenElse(hn::And(hn::Gt(u, zero), hn::Le(u, Constant(kMost))), value, special);
}

// sqrt(x^2 + y^2) for y > 0 of ordinary size.
HWY_INLINE V64 Hypotenuse(V64 x, V64 y) {
  const V64 magnitude = hn::Abs(x);
  return hn::IfThenElse(hn::Gt(magnitude, Constant(1e150)), magnitude, hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y))));
}

// One structure a curve. Value: T(f c). Difference: T(f c) - T(m c) and dT/df. InverseSlope, Curvature: of v.

struct LogOnePlusCurve {
  HWY_INLINE V64 Value(V64 f, V64 c) const { return LogOnePlus(hn::Mul(f, c)); }
  // One logarithm for two: ln(1 + a) - ln(1 + b) = ln(1 + (a - b) / (1 + b)), with b the smaller one.
  HWY_INLINE V64 Difference(V64 f, V64 m, V64 c, V64* slope) const {
    const V64 one = Constant(1), gap = hn::Mul(hn::Sub(f, m), c);
    *slope = hn::Div(c, hn::MulAdd(f, c, one));
    const V64 smaller = hn::IfThenElse(hn::Lt(f, m), f, m);
    return hn::CopySign(LogOnePlus(hn::Div(hn::Abs(gap), hn::MulAdd(smaller, c, one))), gap);
  }
  HWY_INLINE V64 InverseSlope(V64 v) const { return hn::Add(Constant(1), v); }
  HWY_INLINE V64 Curvature(V64 v) const {
    const V64 u = hn::Add(Constant(1), v);
    return hn::Div(Constant(-1), hn::Mul(u, u));
  }
};

struct CubeRootCurve {
  HWY_INLINE V64 Value(V64 f, V64 c) const { return CubeRoot(hn::Mul(f, c)); }
  HWY_INLINE V64 Difference(V64 f, V64 m, V64 c, V64* slope) const {
    const V64 a = CubeRoot(hn::Mul(f, c)), b = CubeRoot(hn::Mul(m, c)), a2 = hn::Mul(a, a);
    const V64 least = hn::MulAdd(hn::Abs(b), Constant(0.01), Constant(1e-15));
    *slope = hn::Div(c, hn::Mul(Constant(3), hn::Max(a2, hn::Mul(least, least))));
    // a - b = (a^3 - b^3) / (a^2 + a b + b^2).
    const V64 gap = hn::Mul(hn::Sub(f, m), c), size = hn::Abs(gap);
    const V64 quotient = hn::Div(gap, hn::MulAdd(b, hn::Add(a, b), a2));
    const auto ordinary = hn::And(hn::Gt(size, hn::Zero(D64())), hn::Le(size, Constant(kMost)));
    return hn::IfThenElse(ordinary, quotient, hn::Sub(a, b));
  }
  HWY_INLINE V64 InverseSlope(V64 v) const {
    const V64 root = CubeRoot(v);
    return hn::Mul(Constant(3), hn::Mul(root, root));
  }
  HWY_INLINE V64 Curvature(V64 v) const {
    const V64 root = CubeRoot(v);
    return hn::Div(Constant(-2.0 / 9), hn::Mul(v, hn::Mul(root, root)));
  }
};

struct LinearCurve {
  HWY_INLINE V64 Value(V64 f, V64 c) const { return hn::Mul(f, c); }
  HWY_INLINE V64 Difference(V64 f, V64 m, V64 c, V64* slope) const {
    *slope = c;
    return hn::Mul(hn::Sub(f, m), c);
  }
  HWY_INLINE V64 InverseSlope(V64 /*v*/) const { return Constant(1); }
  HWY_INLINE V64 Curvature(V64 /*v*/) const { return hn::Zero(D64()); }
};

struct RelativeCurve {
  HWY_INLINE V64 Value(V64 f, V64 /*c*/) const { return f; }
  HWY_INLINE V64 Difference(V64 f, V64 m, V64 /*c*/, V64* slope) const {
    *slope = hn::Div(Constant(1), m);
    return hn::Div(hn::Sub(f, m), m);
  }
  HWY_INLINE V64 InverseSlope(V64 v) const { return v; }
  // f / m, not T(f), is what noise in m bends, and the slope 1 / m with it: where f = v the mean of (f / m - 1) v / m
  // is 2 s^2 / v^2.
  HWY_INLINE V64 Curvature(V64 v) const { return hn::Div(hn::Div(Constant(-4), v), v); }
};

struct AsinhCurve {
  V64 knee, mean_shift;
  bool shifts;  // floor_shift, poisson_shift
  V64 floor_shift, poisson_shift;

  HWY_INLINE V64 Value(V64 f, V64 c) const {
    const V64 v = hn::Mul(f, c);
    return hn::CopySign(LogOnePlus(ExpMinusOne(v)), v);
  }
  // Of one sign, with a >= b >= 0, A = sqrt(a^2 + knee^2) and B alike: ln((a + A) / (b + B)) = ln(1 + (a - b) (1 + (a +
  // b) / (A + B)) / (b + B)). Of two signs: a sum.
  HWY_INLINE V64 Difference(V64 f, V64 m, V64 c, V64* slope) const {
    const V64 half = Constant(0.5), one = Constant(1), gap = hn::Mul(hn::Sub(f, m), c);
    const V64 v = hn::Mul(f, c), w = hn::Mul(m, c), a = hn::Abs(v), b = hn::Abs(w);
    const V64 model = Hypotenuse(v, knee), measured = Hypotenuse(w, knee);
    const auto less = hn::Lt(a, b);
    const V64 low = hn::IfThenElse(less, hn::Add(a, model), hn::Add(b, measured));
    const V64 mean = hn::Div(hn::MulAdd(half, a, hn::Mul(half, b)), hn::MulAdd(half, model, hn::Mul(half, measured)));
    const V64 infinity = Constant(kInfinity), size = hn::Abs(gap);
    const V64 same = hn::Mul(hn::Div(size, low), hn::Add(one, hn::IfThenElse(hn::Eq(size, infinity), one, mean)));
    const V64 p = ExpMinusOne(v), q = ExpMinusOne(w), both = hn::Add(hn::MulAdd(p, q, p), q);
    const auto opposite = hn::Lt(hn::Mul(v, w), hn::Zero(D64()));
    const V64 difference = hn::CopySign(LogOnePlus(hn::IfThenElse(opposite, both, same)), gap);
    const V64 inverse = hn::Div(one, model), ratio = hn::Mul(knee, inverse);
    *slope = hn::Mul(hn::Mul(c, inverse), hn::NegMulAdd(mean_shift, hn::Mul(ratio, ratio), one));
    // v / sqrt(v^2 + knee^2) at infinity is 1.
    const V64 sine = hn::IfThenElse(hn::Eq(a, infinity), one, hn::Mul(v, inverse));
    V64 shifted = hn::NegMulAdd(mean_shift, sine, difference);
    if (shifts) {
      // v (floor_shift + poisson_shift |v|) / (v^2 + knee^2)^(3/2) and its derivative.
      const V64 three = Constant(3), inverse2 = hn::Mul(inverse, inverse), square = hn::Mul(sine, sine);
      const V64 per_v = hn::Mul(inverse2, hn::MulAdd(poisson_shift, hn::Abs(sine), hn::Mul(floor_shift, inverse)));
      shifted = hn::NegMulAdd(v, hn::IfThenElse(hn::Eq(a, infinity), hn::Zero(D64()), per_v), shifted);
      const V64 of_floor = hn::Mul(hn::Mul(floor_shift, inverse), hn::NegMulAdd(three, square, one)),
                of_poisson = hn::Mul(hn::Mul(poisson_shift, hn::Abs(sine)), hn::NegMulAdd(three, square, Constant(2)));
      *slope = hn::NegMulAdd(hn::Mul(c, inverse2), hn::Add(of_floor, of_poisson), *slope);
    }
    return shifted;
  }
  HWY_INLINE V64 InverseSlope(V64 v) const { return Hypotenuse(v, knee); }
  HWY_INLINE V64 Curvature(V64 /*v*/) const { return hn::Zero(D64()); }

 private:
  // exp(asinh(x)) - 1 for x = |v| / knee.
  HWY_INLINE V64 ExpMinusOne(V64 v) const {
    const V64 one = Constant(1), x = hn::Div(hn::Abs(v), knee);
    const V64 share = hn::Div(x, hn::Add(one, Hypotenuse(x, one)));
    return hn::MulAdd(x, hn::IfThenElse(hn::Eq(x, Constant(kInfinity)), one, share), x);
  }
};

// Calls run(curve) with the structure of the transform's curve.
template <class Run>
HWY_INLINE void WithCurve(const Transform& transform, const Run& run) {
  switch (transform.curve) {
    case Curve::kLogOnePlus:
      return run(LogOnePlusCurve{});
    case Curve::kCubeRoot:
      return run(CubeRootCurve{});
    case Curve::kLinear:
      return run(LinearCurve{});
    case Curve::kRelative:
      return run(RelativeCurve{});
    case Curve::kAsinh:
      return run(AsinhCurve{Constant(transform.knee), Constant(transform.mean_shift),
                            transform.floor_shift != 0 || transform.poisson_shift != 0, Constant(transform.floor_shift),
                            Constant(transform.poisson_shift)});
  }
}

// Calls each(in, out) with the arrays at every whole vector of samples, then with copies of what is left, padded by
// ones, whose results are copied back. Null arrays stay null.
template <std::size_t kIn, std::size_t kOut, class Each>
HWY_INLINE void ForVectors(const double* const (&in)[kIn], double* const (&out)[kOut], std::size_t count,
                           const Each& each) {
  const std::size_t lanes = hn::Lanes(D64());
  const double* from[kIn];
  double* to[kOut];
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    for (std::size_t k = 0; k < kIn; ++k) from[k] = in[k] != nullptr ? in[k] + i : nullptr;
    for (std::size_t k = 0; k < kOut; ++k) to[k] = out[k] != nullptr ? out[k] + i : nullptr;
    each(from, to);
  }
  if (i == count) return;
  constexpr std::size_t kMaxLanes = hn::MaxLanes(D64());
  double pads[kIn + kOut][kMaxLanes];
  for (std::size_t k = 0; k < kIn; ++k) {
    from[k] = in[k] != nullptr ? pads[k] : nullptr;
    std::fill_n(pads[k], kMaxLanes, 1.0);
    if (in[k] != nullptr) std::copy(in[k] + i, in[k] + count, pads[k]);
  }
  for (std::size_t k = 0; k < kOut; ++k) to[k] = out[k] != nullptr ? pads[kIn + k] : nullptr;
  each(from, to);
  for (std::size_t k = 0; k < kOut; ++k) {
    if (out[k] != nullptr) std::copy_n(to[k], count - i, out[k] + i);
  }
}

void ResidualArrays(const Transform& transform, const double* f, const double* cos_i, const double* measured,
                    const double* sqrt_weight, std::size_t count, double* residual, double* slope) {
  const double* const in[] = {f, cos_i, measured, sqrt_weight};
  double* const out[] = {residual, slope};
  WithCurve(transform, [&](const auto& curve) HWY_ATTR {
    ForVectors(in, out, count, [&](const double* const* from, double* const* to) HWY_ATTR {
      V64 g;
      const V64 difference = curve.Difference(Load(from[0]), Load(from[2]), Load(from[1]), &g);
      const V64 w = from[3] != nullptr ? Load(from[3]) : Constant(1);
      hn::StoreU(hn::Mul(w, difference), D64(), to[0]);
      if (to[1] != nullptr) hn::StoreU(hn::Mul(w, g), D64(), to[1]);
    });
  });
}

void ValueArrays(const Transform& transform, const double* f_r, const double* cos_i, std::size_t count,
                 double* values) {
  const double* const in[] = {f_r, cos_i};
  double* const out[] = {values};
  WithCurve(transform, [&](const auto& curve) HWY_ATTR {
    ForVectors(in, out, count, [&](const double* const* from, double* const* to) HWY_ATTR {
      hn::StoreU(curve.Value(Load(from[0]), Load(from[1])), D64(), to[0]);
    });
  });
}

void InverseSlopeArrays(const Transform& transform, const double* f, const double* cos_i, std::size_t count,
                        double* to_array) {
  const double* const in[] = {f, cos_i};
  double* const out[] = {to_array};
  WithCurve(transform, [&](const auto& curve) HWY_ATTR {
    ForVectors(in, out, count, [&](const double* const* from, double* const* to) HWY_ATTR {
      hn::StoreU(curve.InverseSlope(hn::Mul(Load(from[0]), Load(from[1]))), D64(), to[0]);
    });
  });
}

void CurvatureArrays(const Transform& transform, const double* f, const double* cos_i, std::size_t count,
                     double* to_array) {
  const double* const in[] = {f, cos_i};
  double* const out[] = {to_array};
  WithCurve(transform, [&](const auto& curve) HWY_ATTR {
    ForVectors(in, out, count, [&](const double* const* from, double* const* to) HWY_ATTR {
      hn::StoreU(curve.Curvature(hn::Mul(Load(from[0]), Load(from[1]))), D64(), to[0]);
    });
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace lobefit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobefit {
HWY_EXPORT(ResidualArrays);
HWY_EXPORT(ValueArrays);
HWY_EXPORT(InverseSlopeArrays);
HWY_EXPORT(CurvatureArrays);

void Residuals(const Transform& transform, const double* f, const double* cos_i, const double* measured,
               const double* sqrt_weight, std::size_t count, double* residual, double* slope) {
  HWY_DYNAMIC_DISPATCH(ResidualArrays)(transform, f, cos_i, measured, sqrt_weight, count, residual, slope);
}
void ApplyTransform(const Transform& transform, const double* f_r, const double* cos_i, std::size_t count,
                    double* values) {
  HWY_DYNAMIC_DISPATCH(ValueArrays)(transform, f_r, cos_i, count, values);
}
void InverseSlopes(const Transform& transform, const double* f, const double* cos_i, std::size_t count, double* to) {
  HWY_DYNAMIC_DISPATCH(InverseSlopeArrays)(transform, f, cos_i, count, to);
}
void Curvatures(const Transform& transform, const double* f, const double* cos_i, std::size_t count, double* to) {
  HWY_DYNAMIC_DISPATCH(CurvatureArrays)(transform, f, cos_i, count, to);
}

}  // namespace lobefit
#endif  // HWY_ONCE
