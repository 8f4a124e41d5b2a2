#include "lobefit/fit/objective/kernel_arrays.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel_arrays.cc"
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

// Cube root, odd, 0 at 0: a third of the exponent (through the upper half of the bits as a number) is within 6 %, two
// steps of Halley's method and one of Newton's leave rounding. A quarter of the time of exp(log(x) / 3).
HWY_INLINE V64 CubeRoot(V64 x) {
  const D64 d;
  const hn::RebindToUnsigned<D64> bits;
  const V64 magnitude = hn::Max(hn::Abs(x), Constant(1e-300));
  // 2^52 + n holds the integer n in its lowest bits.
  const V64 shift = Constant(4503599627370496.0);
  const V64 upper = hn::Sub(
      hn::BitCast(d, hn::Or(hn::ShiftRight<32>(hn::BitCast(bits, magnitude)), hn::BitCast(bits, shift))), shift);
  // 715094163 = (2 / 3 of the exponent's bias, less 0.045) in units of the upper half.
  const V64 third = hn::Add(hn::MulAdd(upper, Constant(1.0 / 3), Constant(715094163.0)), shift);
  V64 y = hn::BitCast(d, hn::ShiftLeft<32>(hn::BitCast(bits, third)));
  for (int step = 0; step < 2; ++step) {
    const V64 cube = hn::Mul(hn::Mul(y, y), y), twice = hn::Add(cube, cube);
    y = hn::Div(hn::Mul(y, hn::Add(cube, hn::Add(magnitude, magnitude))), hn::Add(twice, magnitude));
  }
  const V64 y2 = hn::Mul(y, y);
  y = hn::Sub(y, hn::Div(hn::Sub(hn::Mul(y2, y), magnitude), hn::Mul(Constant(3), y2)));
  return hn::IfThenElse(hn::Eq(x, hn::Zero(d)), hn::Zero(d), hn::CopySign(y, x));
}

// ln(1 + v) as ln(u) + what rounding took from u = 1 + v.
HWY_INLINE V64 LogOnePlus(V64 v) {
  const V64 one = Constant(1), u = hn::Add(one, v);
  return hn::Add(hn::Log(D64(), u), hn::Div(hn::Sub(v, hn::Sub(u, one)), u));
}

// T(f); kRelative: f itself.
HWY_INLINE V64 ApplyTransform(Transform transform, V64 f, V64 cos_i) {
  const V64 v = hn::Mul(f, cos_i);
  switch (transform) {
    case Transform::kLog1p:
      return LogOnePlus(v);
    case Transform::kCubeRoot:
      return CubeRoot(v);
    case Transform::kRelative:
      return f;
    case Transform::kLinear:
      break;
  }
  return v;
}

// T(f) - T(m) and dT/df; `m` measured. Relative: f / m - 1.
HWY_INLINE V64 Difference(Transform transform, V64 f, V64 m, V64 c, V64* slope) {
  const V64 one = Constant(1);
  switch (transform) {
    case Transform::kLog1p:
      // One logarithm for two: ln(1 + f c) - ln(1 + m c) = ln(1 + (f - m) c / (1 + m c)).
      *slope = hn::Div(c, hn::MulAdd(f, c, one));
      return LogOnePlus(hn::Div(hn::Mul(hn::Sub(f, m), c), hn::MulAdd(m, c, one)));
    case Transform::kCubeRoot: {
      const V64 root = CubeRoot(hn::Mul(f, c)), target = CubeRoot(hn::Mul(m, c));
      // Where the model vanishes the slope is infinite: it is that at a millionth of the measured value at most.
      const V64 least = hn::MulAdd(hn::Abs(target), Constant(0.01), Constant(1e-15));
      *slope = hn::Div(c, hn::Mul(Constant(3), hn::Max(hn::Mul(root, root), hn::Mul(least, least))));
      return hn::Sub(root, target);
    }
    case Transform::kRelative:
      *slope = hn::Div(one, m);
      return hn::Mul(hn::Sub(f, m), *slope);
    case Transform::kLinear:
      break;
  }
  *slope = c;
  return hn::Mul(hn::Sub(f, m), c);
}

void TransformArrays(int transform, const double* f_r, const double* cos_i, std::size_t count, double* target) {
  const std::size_t lanes = hn::Lanes(D64());
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    hn::StoreU(ApplyTransform(static_cast<Transform>(transform), Load(f_r + i), Load(cos_i + i)), D64(), target + i);
  }
  if (i == count) return;
  constexpr std::size_t kMaxLanes = hn::MaxLanes(D64());
  double pad_f[kMaxLanes] = {}, pad_c[kMaxLanes] = {}, out[kMaxLanes];
  std::copy(f_r + i, f_r + count, pad_f);
  std::copy(cos_i + i, cos_i + count, pad_c);
  hn::StoreU(ApplyTransform(static_cast<Transform>(transform), Load(pad_f), Load(pad_c)), D64(), out);
  std::copy(out, out + (count - i), target + i);
}

// p5 = (1 - cos_d)^5 and 1 - p5: Schlick's factor is f0 + (1 - f0) p5, its derivative by f0 1 - p5 (n a multiple of the
// lanes).
void SchlickArrays(const double* cos_d, std::size_t n, double* p5, double* one_minus_p5) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) {
    const V64 x = hn::Sub(Constant(1), Load(cos_d + i));
    const V64 x2 = hn::Mul(x, x);
    const V64 power = hn::Mul(hn::Mul(x2, x2), x);
    hn::StoreU(power, D64(), p5 + i);
    hn::StoreU(hn::Sub(Constant(1), power), D64(), one_minus_p5 + i);
  }
}

// to[k] = sum_j jacobian[j][k] from[j], arrays of n with the given strides.
void ContractArrays(const double* from, const double* jacobian, std::size_t columns, std::size_t n, std::size_t stride,
                    double* to) {
  for (std::size_t k = 0; k < columns; ++k) {
    for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) {
      V64 sum = hn::Zero(D64());
      for (std::size_t j = 0; j < 5; ++j)
        sum = hn::MulAdd(Constant(jacobian[j * columns + k]), Load(from + j * stride + i), sum);
      hn::StoreU(sum, D64(), to + k * stride + i);
    }
  }
}

// to += a * (constant + slope * array).
void AddFactorArrays(const double* a, double constant, double slope, const double* array, std::size_t n, double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) {
    const V64 factor = hn::MulAdd(Constant(slope), Load(array + i), Constant(constant));
    hn::StoreU(hn::MulAdd(Load(a + i), factor, Load(to + i)), D64(), to + i);
  }
}

// to += factor * a.
void AddScaledArrays(const double* a, double factor, std::size_t n, double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64()))
    hn::StoreU(hn::MulAdd(Constant(factor), Load(a + i), Load(to + i)), D64(), to + i);
}

// residual = sqrt_weight (T(f) - T(measured)), slope = sqrt_weight dT/df (null: not wanted); sqrt_weight null: 1.
void ResidualArrays(int transform, const double* f, const double* cos_i, const double* measured,
                    const double* sqrt_weight, std::size_t n, double* residual, double* slope) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) {
    V64 g;
    const V64 difference =
        Difference(static_cast<Transform>(transform), Load(f + i), Load(measured + i), Load(cos_i + i), &g);
    const V64 w = sqrt_weight != nullptr ? Load(sqrt_weight + i) : Constant(1);
    hn::StoreU(hn::Mul(w, difference), D64(), residual + i);
    if (slope != nullptr) hn::StoreU(hn::Mul(w, g), D64(), slope + i);
  }
}

// to = sqrt(scale * to).
void FinishWeightArrays(double scale, std::size_t n, double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64()))
    hn::StoreU(hn::Sqrt(hn::Mul(Constant(scale), Load(to + i))), D64(), to + i);
}
// to *= sine of the angle whose cosine is given.
void TimesSineArrays(const double* cosine, std::size_t n, double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) {
    const V64 c = Load(cosine + i);
    const V64 sine = hn::Sqrt(hn::Max(hn::Zero(D64()), hn::NegMulAdd(c, c, Constant(1))));
    hn::StoreU(hn::Mul(Load(to + i), sine), D64(), to + i);
  }
}

// Shape columns of one lobe and channel: to[k] = slope * (constant + factor_slope * factor) * gradient[k], plus slope *
// albedo * diffuse_gradient[k] where that is not null.
void ShapeColumnArrays(const double* slope, double constant, double factor_slope, const double* factor,
                       const double* gradient, double albedo, const double* diffuse_gradient, std::size_t columns,
                       std::size_t n, std::size_t stride, double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) {
    const V64 s = Load(slope + i);
    const V64 product = hn::Mul(s, hn::MulAdd(Constant(factor_slope), Load(factor + i), Constant(constant)));
    for (std::size_t k = 0; k < columns; ++k) {
      V64 column = hn::Mul(product, Load(gradient + k * stride + i));
      if (diffuse_gradient != nullptr)
        column = hn::MulAdd(hn::Mul(s, Constant(albedo)), Load(diffuse_gradient + k * stride + i), column);
      hn::StoreU(column, D64(), to + k * stride + i);
    }
  }
}

// to = a * b * c.
void ProductArrays(const double* a, const double* b, const double* c, std::size_t n, double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64()))
    hn::StoreU(hn::Mul(hn::Mul(Load(a + i), Load(b + i)), Load(c + i)), D64(), to + i);
}

// Sum of squares.
double SquareArrays(const double* a, std::size_t n) {
  const D64 d;
  V64 sum = hn::Zero(d);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) sum = hn::MulAdd(Load(a + i), Load(a + i), sum);
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

void MultiplyArrays(const double* a, const double* b, std::size_t n, double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) hn::StoreU(hn::Mul(Load(a + i), Load(b + i)), D64(), to + i);
}

// Adds the upper triangle of the Gram matrix of `columns` arrays to `gram`, row by row.
void GramArrays(const double* columns, std::size_t count, std::size_t n, std::size_t stride, double* gram) {
  const D64 d;
  for (std::size_t i = 0; i < count; ++i) {
    const double* a = columns + i * stride;
    std::size_t j = i;
    for (; j + 4 <= count; j += 4) {
      const double* b = columns + j * stride;
      V64 s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0;
      for (std::size_t k = 0; k < n; k += hn::Lanes(d)) {
        const V64 x = Load(a + k);
        s0 = hn::MulAdd(x, Load(b + k), s0);
        s1 = hn::MulAdd(x, Load(b + stride + k), s1);
        s2 = hn::MulAdd(x, Load(b + 2 * stride + k), s2);
        s3 = hn::MulAdd(x, Load(b + 3 * stride + k), s3);
      }
      *gram++ += hn::GetLane(hn::SumOfLanes(d, s0));
      *gram++ += hn::GetLane(hn::SumOfLanes(d, s1));
      *gram++ += hn::GetLane(hn::SumOfLanes(d, s2));
      *gram++ += hn::GetLane(hn::SumOfLanes(d, s3));
    }
    for (; j < count; ++j) {
      const double* b = columns + j * stride;
      V64 s0 = hn::Zero(d);
      for (std::size_t k = 0; k < n; k += hn::Lanes(d)) s0 = hn::MulAdd(Load(a + k), Load(b + k), s0);
      *gram++ += hn::GetLane(hn::SumOfLanes(d, s0));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lobefit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobefit {
HWY_EXPORT(TransformArrays);
HWY_EXPORT(SchlickArrays);
HWY_EXPORT(ContractArrays);
HWY_EXPORT(AddFactorArrays);
HWY_EXPORT(AddScaledArrays);
HWY_EXPORT(ResidualArrays);
HWY_EXPORT(FinishWeightArrays);
HWY_EXPORT(TimesSineArrays);
HWY_EXPORT(ShapeColumnArrays);
HWY_EXPORT(ProductArrays);
HWY_EXPORT(MultiplyArrays);
HWY_EXPORT(SquareArrays);
HWY_EXPORT(GramArrays);

namespace arrays {

void Transformed(Transform transform, const double* f_r, const double* cos_i, std::size_t count, double* target) {
  HWY_DYNAMIC_DISPATCH(TransformArrays)(static_cast<int>(transform), f_r, cos_i, count, target);
}
void Schlick(const double* cos_d, std::size_t n, double* p5, double* one_minus_p5) {
  HWY_DYNAMIC_DISPATCH(SchlickArrays)(cos_d, n, p5, one_minus_p5);
}
void Contract(const double* from, const double* jacobian, std::size_t columns, std::size_t n, std::size_t stride,
              double* to) {
  HWY_DYNAMIC_DISPATCH(ContractArrays)(from, jacobian, columns, n, stride, to);
}
void AddFactor(const double* a, double constant, double slope, const double* array, std::size_t n, double* to) {
  HWY_DYNAMIC_DISPATCH(AddFactorArrays)(a, constant, slope, array, n, to);
}
void AddScaled(const double* a, double factor, std::size_t n, double* to) {
  HWY_DYNAMIC_DISPATCH(AddScaledArrays)(a, factor, n, to);
}
void Residuals(Transform transform, const double* f, const double* cos_i, const double* measured,
               const double* sqrt_weight, std::size_t n, double* residual, double* slope) {
  HWY_DYNAMIC_DISPATCH(ResidualArrays)
  (static_cast<int>(transform), f, cos_i, measured, sqrt_weight, n, residual, slope);
}
void FinishWeight(double scale, std::size_t n, double* to) { HWY_DYNAMIC_DISPATCH(FinishWeightArrays)(scale, n, to); }
void TimesSine(const double* cosine, std::size_t n, double* to) {
  HWY_DYNAMIC_DISPATCH(TimesSineArrays)(cosine, n, to);
}
void ShapeColumn(const double* slope, double constant, double factor_slope, const double* factor,
                 const double* gradient, double albedo, const double* diffuse_gradient, std::size_t columns,
                 std::size_t n, std::size_t stride, double* to) {
  HWY_DYNAMIC_DISPATCH(ShapeColumnArrays)
  (slope, constant, factor_slope, factor, gradient, albedo, diffuse_gradient, columns, n, stride, to);
}
void Product(const double* a, const double* b, const double* c, std::size_t n, double* to) {
  HWY_DYNAMIC_DISPATCH(ProductArrays)(a, b, c, n, to);
}
void Multiply(const double* a, const double* b, std::size_t n, double* to) {
  HWY_DYNAMIC_DISPATCH(MultiplyArrays)(a, b, n, to);
}
double SumOfSquares(const double* a, std::size_t n) { return HWY_DYNAMIC_DISPATCH(SquareArrays)(a, n); }
void AddGram(const double* columns, std::size_t count, std::size_t n, std::size_t stride, double* gram) {
  HWY_DYNAMIC_DISPATCH(GramArrays)(columns, count, n, stride, gram);
}

}  // namespace arrays
}  // namespace lobefit
#endif  // HWY_ONCE
