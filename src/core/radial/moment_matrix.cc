#include "lobefit/core/radial/moment_matrix.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "moment_matrix.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After highway.h.
#include <hwy/contrib/math/math-inl.h>

#ifndef LOBEFIT_CORE_MOMENT_BLOCK
#define LOBEFIT_CORE_MOMENT_BLOCK
namespace lobefit {
constexpr std::size_t kRowsOfBlock = 16, kColumnsOfBlock = 4;
}
#endif

HWY_BEFORE_NAMESPACE();
namespace lobefit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D64 = hn::CappedTag<double, 8>;
using V64 = hn::Vec<D64>;

// e^E and e^E - 1 of `count` points of an interval.
void DensityArrays(const double* cubic, const double* x, std::size_t count, double* density, double* excess) {
  const D64 d;
  const V64 c0 = hn::Set(d, cubic[0]), c1 = hn::Set(d, cubic[1]), c2 = hn::Set(d, cubic[2]), c3 = hn::Set(d, cubic[3]),
            most = hn::Set(d, 709.0);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V64 at = hn::LoadU(d, x + i);
    const V64 e = hn::Min(hn::MulAdd(hn::MulAdd(hn::MulAdd(c3, at, c2), at, c1), at, c0), most);
    hn::StoreU(hn::Exp(d, e), d, density + i);
    hn::StoreU(hn::Expm1(d, e), d, excess + i);
  }
}

// products[column][row] of one block of rows with the four columns of values[point][column].
void BlockProduct(const double* weights, const double* values, std::size_t stride, std::size_t points,
                  double* products) {
  const D64 d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t row = 0; row < kRowsOfBlock; row += 2 * lanes) {
    // An odd vector of the block is computed twice where it is but one.
    const std::size_t second = row + lanes < kRowsOfBlock ? row + lanes : row;
    V64 a[kColumnsOfBlock], b[kColumnsOfBlock];
    for (std::size_t c = 0; c < kColumnsOfBlock; ++c) a[c] = b[c] = hn::Zero(d);
    for (std::size_t p = 0; p < points; ++p) {
      const V64 wa = hn::LoadU(d, weights + p * kRowsOfBlock + row),
                wb = hn::LoadU(d, weights + p * kRowsOfBlock + second);
      for (std::size_t c = 0; c < kColumnsOfBlock; ++c) {
        const V64 value = hn::Set(d, values[p * stride + c]);
        a[c] = hn::MulAdd(wa, value, a[c]);
        b[c] = hn::MulAdd(wb, value, b[c]);
      }
    }
    for (std::size_t c = 0; c < kColumnsOfBlock; ++c) {
      hn::StoreU(a[c], d, products + c * kRowsOfBlock + row);
      hn::StoreU(b[c], d, products + c * kRowsOfBlock + second);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lobefit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <cmath>

#include "lobefit/math/vec.h"

namespace lobefit {
HWY_EXPORT(DensityArrays);
HWY_EXPORT(BlockProduct);

namespace {

// Chebyshev's points of the second kind; their barycentric weights have alternate signs, half at the ends.
constexpr double WeightOf(std::size_t j) {
  const double sign = j % 2 == 0 ? 1 : -1;
  return j == 0 || j + 1 == MomentMatrix::kPoints ? 0.5 * sign : sign;
}

}  // namespace

MomentMatrix::MomentMatrix(const ProfileSpline& spline, double end) {
  for (std::size_t j = 0; j < kPoints; ++j)
    chebyshev_[j] = 0.5 - 0.5 * std::cos(kPi * static_cast<double>(j) / static_cast<double>(kPoints - 1));
  const std::size_t intervals = spline.intervals(), K = spline.size();
  basis_.resize(K * intervals * kPoints);
  for (std::size_t i = 0; i < intervals; ++i) {
    widths_.push_back((i + 1 < intervals ? spline.Left(i + 1) : end) - spline.Left(i));
    const double* c = spline.Coefficients(i);
    for (const double share : chebyshev_) {
      const double x = share * widths_.back();
      for (std::size_t k = 0; k < K; ++k)
        basis_[k * intervals * kPoints + x_.size()] = c[k] + x * (c[K + k] + x * (c[2 * K + k] + x * c[3 * K + k]));
      x_.push_back(x);
    }
  }
}

void MomentMatrix::Add(const ProfilePoints& points) {
  const std::size_t row = weights_.size();
  weights_.resize(row + 3 * columns(), 0.0);
  rows_ += 3;
  points.ForEach([&](std::size_t interval, double x, const std::array<double, 3>& weights) {
    const double at = x / widths_[interval];
    std::array<double, kPoints> share;
    double sum = 0;
    for (std::size_t j = 0; j < kPoints; ++j) {
      const double away = at - chebyshev_[j];
      // Nearer than this the point is the Chebyshev point to rounding.
      share[j] = WeightOf(j) / (std::fabs(away) < 1e-300 ? 1e-300 : away);
      sum += share[j];
    }
    double* to = weights_.data() + row + interval * kPoints;
    for (std::size_t m = 0; m < 3; ++m, to += columns()) {
      for (std::size_t j = 0; j < kPoints; ++j) to[j] += weights[m] * (share[j] / sum);
    }
  });
}

void MomentMatrix::Finish() {
  std::vector<double> blocks;
  for (std::size_t row = 0; row < rows_; row += kRowsOfBlock) {
    const std::size_t rows = std::min(kRowsOfBlock, rows_ - row);
    const double* of_row = weights_.data() + row * columns();
    std::size_t first = columns();
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t p = 0; p < first; ++p) {
        if (of_row[r * columns() + p] != 0) first = p;
      }
    }
    for (std::size_t p = first; p < columns(); ++p) {
      for (std::size_t r = 0; r < kRowsOfBlock; ++r) blocks.push_back(r < rows ? of_row[r * columns() + p] : 0.0);
    }
    first_.push_back(first);
  }
  weights_ = std::move(blocks);
}

bool MomentMatrix::Resolves(const Profile& profile) const {
  constexpr double kMost = 20;
  for (std::size_t i = 0; i < widths_.size(); ++i) {
    const double* c = profile.Cubic(i);
    const double h = widths_[i];
    if (!(h * (std::fabs(c[1]) + h * (std::fabs(c[2]) + h * std::fabs(c[3]))) <= kMost)) return false;
  }
  return true;
}

void MomentMatrix::Moments(const Profile& profile, std::size_t stride, double* moments) const {
  const std::size_t K = profile.q().size(), count = columns();
  std::vector<double> density(count), excess(count);
  for (std::size_t i = 0; i < widths_.size(); ++i) {
    HWY_DYNAMIC_DISPATCH(DensityArrays)
    (profile.Cubic(i), x_.data() + i * kPoints, kPoints, density.data() + i * kPoints, excess.data() + i * kPoints);
  }
  const std::size_t wide = (K + kColumnsOfBlock) / kColumnsOfBlock * kColumnsOfBlock;
  std::vector<double> values(count * wide, 0.0);
  for (std::size_t p = 0; p < count; ++p) {
    values[p * wide] = excess[p] - profile.mass_excess();
    for (std::size_t k = 0; k < K; ++k) values[p * wide + 1 + k] = density[p] * basis_[k * count + p];
  }
  std::fill_n(moments, rows_ * stride, 0.0);
  double products[kColumnsOfBlock * kRowsOfBlock];
  const double* weights = weights_.data();
  for (std::size_t block = 0; block < first_.size(); ++block) {
    const std::size_t points = count - first_[block], row = block * kRowsOfBlock;
    for (std::size_t column = 0; column < wide; column += kColumnsOfBlock) {
      HWY_DYNAMIC_DISPATCH(BlockProduct)
      (weights, values.data() + first_[block] * wide + column, wide, points, products);
      for (std::size_t r = 0; r < kRowsOfBlock && row + r < rows_; ++r) {
        for (std::size_t c = 0; c < kColumnsOfBlock && column + c <= K; ++c)
          moments[(row + r) * stride + column + c] = products[c * kRowsOfBlock + r];
      }
    }
    weights += points * kRowsOfBlock;
  }
}

}  // namespace lobefit
#endif  // HWY_ONCE
