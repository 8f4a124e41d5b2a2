#include "lobefit/fit/kernel/kernel_arrays.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel_arrays.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lobefit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D64 = hn::CappedTag<double, 8>;  // arrays are padded to 8
using V64 = hn::Vec<D64>;

HWY_INLINE V64 Load(const double* p) { return hn::LoadU(D64(), p); }
HWY_INLINE V64 Constant(double x) { return hn::Set(D64(), x); }

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

// The operations of FresnelCurveBasis, in the interval of each lane: its knots from the third before to the third
// behind.
void CurveBasisArrays(const double* cos_d, std::size_t n, std::size_t stride, double* to) {
  constexpr double kKnots[] = {0, 0, 0, 0, 0.25, 0.6, 1, 1, 1, 1};
  const D64 d;
  const V64 zero = hn::Zero(d);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const V64 c = Load(cos_d + i);
    const auto second = hn::Ge(c, Constant(kKnots[4])), third = hn::Ge(c, Constant(kKnots[5]));
    V64 knots[6];
    for (std::size_t k = 0; k < 6; ++k) {
      knots[k] = hn::IfThenElse(second, Constant(kKnots[k + 2]), Constant(kKnots[k + 1]));
      knots[k] = hn::IfThenElse(third, Constant(kKnots[k + 3]), knots[k]);
    }
    V64 N[4] = {Constant(1), zero, zero, zero};
    for (std::size_t p = 1; p < 4; ++p) {
      V64 saved = zero;
      for (std::size_t j = 0; j < p; ++j) {
        const V64 left = knots[3 - p + j], right = knots[3 + j];
        const V64 part = hn::Div(N[j], hn::Sub(right, left));
        N[j] = hn::Add(saved, hn::Mul(hn::Sub(right, c), part));
        saved = hn::Mul(hn::Sub(c, left), part);
      }
      N[p] = saved;
    }
    for (std::size_t k = 0; k < 6; ++k) {
      const V64 in_first = k < 4 ? N[k] : zero, in_second = k > 0 && k < 5 ? N[k - 1] : zero,
                in_third = k > 1 ? N[k - 2] : zero;
      hn::StoreU(hn::IfThenElse(third, in_third, hn::IfThenElse(second, in_second, in_first)), d, to + k * stride + i);
    }
  }
}

// The columns of ContractArrays from k on, so many at a time: a sum waits four cycles for its last product. Rows that
// have no part in them are left out: half of the Jacobian of a profile, whose coefficients are coordinates themselves,
// and of what whitens many channels.
template <std::size_t kColumns>
HWY_INLINE void ContractTile(const double* from, const double* jacobian, std::size_t rows, std::size_t columns,
                             std::size_t k, std::size_t n, std::size_t stride, double* to) {
  constexpr std::size_t kMostRows = 128;
  std::uint32_t used[kMostRows];
  for (std::size_t begin = 0; begin == 0 || begin < rows; begin += kMostRows) {
    std::size_t count = 0;
    for (std::size_t j = begin; j < rows && j < begin + kMostRows; ++j) {
      bool has_part = false;
      for (std::size_t q = 0; q < kColumns; ++q) has_part = has_part || jacobian[j * columns + k + q] != 0;
      if (has_part) used[count++] = static_cast<std::uint32_t>(j);
    }
    for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) {
      V64 sums[kColumns];
      for (std::size_t q = 0; q < kColumns; ++q)
        sums[q] = begin == 0 ? hn::Zero(D64()) : Load(to + (k + q) * stride + i);
      for (std::size_t u = 0; u < count; ++u) {
        const std::size_t j = used[u];
        const V64 x = Load(from + j * stride + i);
        for (std::size_t q = 0; q < kColumns; ++q)
          sums[q] = hn::MulAdd(Constant(jacobian[j * columns + k + q]), x, sums[q]);
      }
      for (std::size_t q = 0; q < kColumns; ++q) hn::StoreU(sums[q], D64(), to + (k + q) * stride + i);
    }
  }
}

// to[k] = sum_j jacobian[j][k] from[j], j < rows, k < columns, arrays of n with the given strides.
void ContractArrays(const double* from, const double* jacobian, std::size_t rows, std::size_t columns, std::size_t n,
                    std::size_t stride, double* to) {
  constexpr std::size_t kTile = 4;
  std::size_t k = 0;
  for (; k + kTile <= columns; k += kTile) ContractTile<kTile>(from, jacobian, rows, columns, k, n, stride, to);
  switch (columns - k) {
    case 3:
      return ContractTile<3>(from, jacobian, rows, columns, k, n, stride, to);
    case 2:
      return ContractTile<2>(from, jacobian, rows, columns, k, n, stride, to);
    case 1:
      return ContractTile<1>(from, jacobian, rows, columns, k, n, stride, to);
    default:
      return;
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

// to += slope * specular * scale * by_argument * gradient; by_argument null: 1.
void ArgumentColumnArrays(const double* slope, const double* specular, double scale, const double* by_argument,
                          const double* gradient, std::size_t n, double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) {
    V64 product = hn::Mul(hn::Mul(Load(slope + i), Load(specular + i)), hn::Mul(Constant(scale), Load(gradient + i)));
    if (by_argument != nullptr) product = hn::Mul(product, Load(by_argument + i));
    hn::StoreU(hn::Add(Load(to + i), product), D64(), to + i);
  }
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

// Adds the products of kA arrays from column i on with kB from column j on to the upper triangle of `gram`, packed row
// by row. A sum waits four cycles for its last product, so that many are summed at a time; each adds in the
// order of its samples, however many there are.
template <std::size_t kA, std::size_t kB>
HWY_INLINE void AddGramTile(const double* columns, std::size_t i, std::size_t j, std::size_t count, std::size_t n,
                            std::size_t stride, double* gram) {
  const D64 d;
  const double *a = columns + i * stride, *b = columns + j * stride;
  V64 sums[kA][kB];
  for (std::size_t p = 0; p < kA; ++p) {
    for (std::size_t q = 0; q < kB; ++q) sums[p][q] = hn::Zero(d);
  }
  for (std::size_t k = 0; k < n; k += hn::Lanes(d)) {
    V64 y[kB];
    for (std::size_t q = 0; q < kB; ++q) y[q] = Load(b + q * stride + k);
    for (std::size_t p = 0; p < kA; ++p) {
      const V64 x = Load(a + p * stride + k);
      for (std::size_t q = 0; q < kB; ++q) sums[p][q] = hn::MulAdd(x, y[q], sums[p][q]);
    }
  }
  for (std::size_t p = 0; p < kA; ++p) {
    double* row = gram + (i + p) * count - (i + p) * (i + p + 1) / 2;
    for (std::size_t q = 0; q < kB; ++q) {
      if (j + q >= i + p) row[j + q] += hn::GetLane(hn::SumOfLanes(d, sums[p][q]));
    }
  }
}

// kRows rows of the upper triangle from row i on.
template <std::size_t kRows>
HWY_INLINE void AddGramRows(const double* columns, std::size_t i, std::size_t count, std::size_t n, std::size_t stride,
                            double* gram) {
  constexpr std::size_t kColumns = 4;
  std::size_t j = i;
  for (; j + kColumns <= count; j += kColumns) AddGramTile<kRows, kColumns>(columns, i, j, count, n, stride, gram);
  // One at a time the last columns took as long as three times as many.
  switch (count - j) {
    case 3:
      return AddGramTile<kRows, 3>(columns, i, j, count, n, stride, gram);
    case 2:
      return AddGramTile<kRows, 2>(columns, i, j, count, n, stride, gram);
    case 1:
      return AddGramTile<kRows, 1>(columns, i, j, count, n, stride, gram);
    default:
      return;
  }
}

// Adds the upper triangle of the Gram matrix of `columns` arrays to `gram`, row by row.
void GramArrays(const double* columns, std::size_t count, std::size_t n, std::size_t stride, double* gram) {
  // As many sums as there are registers for.
  constexpr std::size_t kRows = HWY_MAX_BYTES >= 64 ? 4 : 2;
  std::size_t i = 0;
  for (; i + kRows <= count; i += kRows) AddGramRows<kRows>(columns, i, count, n, stride, gram);
  for (; i < count; ++i) AddGramRows<1>(columns, i, count, n, stride, gram);
}

}  // namespace HWY_NAMESPACE
}  // namespace lobefit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobefit {
HWY_EXPORT(SchlickArrays);
HWY_EXPORT(CurveBasisArrays);
HWY_EXPORT(ContractArrays);
HWY_EXPORT(AddFactorArrays);
HWY_EXPORT(AddScaledArrays);
HWY_EXPORT(FinishWeightArrays);
HWY_EXPORT(TimesSineArrays);
HWY_EXPORT(ShapeColumnArrays);
HWY_EXPORT(ProductArrays);
HWY_EXPORT(ArgumentColumnArrays);
HWY_EXPORT(MultiplyArrays);
HWY_EXPORT(SquareArrays);
HWY_EXPORT(GramArrays);

namespace arrays {

void Schlick(const double* cos_d, std::size_t n, double* p5, double* one_minus_p5) {
  HWY_DYNAMIC_DISPATCH(SchlickArrays)(cos_d, n, p5, one_minus_p5);
}
void CurveBasis(const double* cos_d, std::size_t n, std::size_t stride, double* to) {
  HWY_DYNAMIC_DISPATCH(CurveBasisArrays)(cos_d, n, stride, to);
}
void Contract(const double* from, const double* jacobian, std::size_t rows, std::size_t columns, std::size_t n,
              std::size_t stride, double* to) {
  HWY_DYNAMIC_DISPATCH(ContractArrays)(from, jacobian, rows, columns, n, stride, to);
}
void AddFactor(const double* a, double constant, double slope, const double* array, std::size_t n, double* to) {
  HWY_DYNAMIC_DISPATCH(AddFactorArrays)(a, constant, slope, array, n, to);
}
void AddScaled(const double* a, double factor, std::size_t n, double* to) {
  HWY_DYNAMIC_DISPATCH(AddScaledArrays)(a, factor, n, to);
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
void AddArgumentColumn(const double* slope, const double* specular, double scale, const double* by_argument,
                       const double* gradient, std::size_t n, double* to) {
  HWY_DYNAMIC_DISPATCH(ArgumentColumnArrays)(slope, specular, scale, by_argument, gradient, n, to);
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
