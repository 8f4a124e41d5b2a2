#include "lobefit/maps/engine/factor.h"

#include <type_traits>

namespace lobefit {
namespace {

// M = L D L^T: row k holds column k of D L^T right of the diagonal, which holds 1 / d_k, and row k of L left of it.
// Without roots, whose latencies would add up.
template <int kSize>
bool FactoriseOf(MapMatrix* matrix) {
  MapMatrix& m = *matrix;
  MapVector before;
  for (int j = 0; j < kSize; ++j) before[j] = m[j][j];
  for (int k = 0; k < kSize; ++k) {
    if (!(m[k][k] > 1e-13 * before[k])) return false;
    const double inverse = 1 / m[k][k];
    for (int j = k + 1; j < kSize; ++j) {
      const double factor = m[k][j] * inverse;
      for (int i = j; i < kSize; ++i) m[j][i] -= factor * m[k][i];
      m[j][k] = factor;
    }
    m[k][k] = inverse;
  }
  return true;
}

template <int kSize>
void SolveOf(const MapMatrix& factor, MapVector* solution) {
  MapVector& x = *solution;
  for (int j = 0; j < kSize; ++j) {
    x[j] *= factor[j][j];
    for (int i = j + 1; i < kSize; ++i) x[i] -= factor[j][i] * x[j];
  }
  // As soon as one is known all others take it, rather than each waiting for a sum.
  for (int i = kSize - 1; i > 0; --i) {
    for (int j = 0; j < i; ++j) x[j] -= factor[i][j] * x[i];
  }
}

// All columns of the inverse together: what one waits for another does meanwhile.
template <int kSize>
void InvertOf(const MapMatrix& factor, MapMatrix* inverse) {
  MapMatrix& x = *inverse;
  for (int j = 0; j < kSize; ++j) {
    for (int c = 0; c < kSize; ++c) x[j][c] *= factor[j][j];
    for (int i = j + 1; i < kSize; ++i) {
      for (int c = 0; c < kSize; ++c) x[i][c] -= factor[j][i] * x[j][c];
    }
  }
  for (int j = kSize - 2; j >= 0; --j) {
    for (int i = j + 1; i < kSize; ++i) {
      for (int c = 0; c < kSize; ++c) x[j][c] -= factor[i][j] * x[i][c];
    }
  }
}

// Calls `function` with the size as a constant.
template <int kSize = kMostUnknowns, class F>
auto BySize(int size, const F& function) {
  if constexpr (kSize > 1) {
    if (size < kSize) return BySize<kSize - 1>(size, function);
  }
  return function(std::integral_constant<int, kSize>{});
}

}  // namespace

bool Factorise(int unknowns, const std::array<bool, kMostUnknowns>& held, MapMatrix* matrix) {
  for (int j = 0; j < unknowns; ++j) {
    if (!held[j]) continue;
    for (int k = 0; k < unknowns; ++k) (*matrix)[j][k] = (*matrix)[k][j] = 0;
    (*matrix)[j][j] = 1;
  }
  return BySize(unknowns, [&](auto size) { return FactoriseOf<size()>(matrix); });
}

void SolveFactorised(int unknowns, const MapMatrix& factor, MapVector* x) {
  BySize(unknowns, [&](auto size) { SolveOf<size()>(factor, x); });
}

MapMatrix InverseOf(int unknowns, const std::array<bool, kMostUnknowns>& held, const MapMatrix& factor) {
  MapMatrix inverse = {};
  for (int j = 0; j < unknowns; ++j) inverse[j][j] = held[j] ? 0 : 1;
  BySize(unknowns, [&](auto size) { InvertOf<size()>(factor, &inverse); });
  return inverse;
}

}  // namespace lobefit
