#include "lobefit/maps/engine/factor.h"

#include <type_traits>

namespace lobefit {
namespace {

// M = L D L^T: row k holds column k of D L^T right of the diagonal, which holds 1 / d_k. Without roots, whose latencies
// would add up.
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
    }
    m[k][k] = inverse;
  }
  return true;
}

template <int kSize>
void SolveOf(const MapMatrix& factor, MapVector* solution) {
  MapVector& x = *solution;
  for (int j = 0; j < kSize; ++j) {
    if (x[j] == 0) continue;  // as for most rows of an inverse
    x[j] *= factor[j][j];
    for (int i = j + 1; i < kSize; ++i) x[i] -= factor[j][i] * x[j];
  }
  for (int j = kSize - 2; j >= 0; --j) {
    double sum = 0;
    for (int i = j + 1; i < kSize; ++i) sum += factor[j][i] * x[i];
    x[j] -= sum * factor[j][j];
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

}  // namespace lobefit
