// Integrals over the micro normals that a direction sees, by nested adaptive Gauss-Kronrod quadrature.
#pragma once

#include <array>
#include <vector>

#include "lobefit/core/ellipsoid/ellipsoid.h"
#include "lobefit/math/quadrature.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// Which normals count besides m.n > 0 and m.wo > 0.
enum class VisibleNormals {
  kAll,
  kReflectUp,  // those that mirror wo to above the horizon
  kFacing,     // those that face a second direction too
};

// Polar coordinates for such sets that no roughness makes narrow: m = A^T x / |A^T x| with the A of an outline of the
// distribution, and x = cos(beta) x0 + sin(beta) (cos(psi) e1 + sin(psi) e2) on the unit sphere, so that an ellipsoid's
// D (m.wo) dm is linear in x [Walter sec 4]. Arcs through x0 are arcs through its normal, around which each set is
// star-shaped: its bound on beta is a closed form in psi.
class VisiblePolar {
 public:
  VisiblePolar(const Ellipsoid& outline, const Vec3& wo, VisibleNormals normals, const Vec3& second = {0, 0, 1});

  // Break points of psi over one turn, ascending; of beta for one psi, ascending from 0.
  const std::vector<double>& azimuth_breaks() const { return azimuth_breaks_; }
  void PolarBreaks(double psi, std::vector<double>* breaks) const;
  // The normal and dm / (dbeta dpsi).
  double Sample(double beta, double psi, Vec3* m) const;

 private:
  Vec3 Stretched(const Vec3& m) const;  // A m
  Vec3 Back(const Vec3& x) const;       // A^T x
  Vec3 Axis(double psi) const { return std::cos(psi) * e1_ + std::sin(psi) * e2_; }

  Ellipsoid outline_;
  Mat3 rotation_, to_world_;
  VisibleNormals normals_;
  Vec3 wo_, center_;  // centre of the star, its x:
  Vec3 x0_, e1_, e2_;
  double center_scale_;       // A^T x0 = center_scale * center
  std::vector<Vec3> facing_;  // m.v > 0 for each
  std::vector<double> azimuth_breaks_;
};

// integral[k] = int f_k(m) dm over the set; f : Vec3 -> std::array<double, N>, all components in one pass. `tolerance`:
// for each component, relative to the integral of its absolute value. `converged`, if not null, says whether every
// interval met it.
template <std::size_t N, class F>
std::array<double, N> IntegrateVisibleNormals(const VisiblePolar& polar, const F& f, double tolerance,
                                              bool* converged = nullptr) {
  std::array<double, N> scale;
  scale.fill(1.0);
  std::vector<double> breaks;
  const auto sample = [&](double beta, double psi) {
    Vec3 m;
    const double dm = polar.Sample(beta, psi, &m);
    std::array<double, N> value = f(m);
    for (std::size_t k = 0; k < N; ++k) value[k] *= dm * scale[k];
    return value;
  };
  // A coarse product rule finds the size of each component, so that no arc is refined beyond what it adds to the whole.
  static const QuadratureRule coarse = GaussLegendre(8);
  std::array<double, N> size{};
  const std::vector<double>& azimuths = polar.azimuth_breaks();
  for (std::size_t a = 0; a + 1 < azimuths.size(); ++a) {
    for (std::size_t i = 0; i < coarse.nodes.size(); ++i) {
      const double half_a = 0.5 * (azimuths[a + 1] - azimuths[a]), psi = azimuths[a] + half_a * (1 + coarse.nodes[i]);
      polar.PolarBreaks(psi, &breaks);
      for (std::size_t b = 0; b + 1 < breaks.size(); ++b) {
        for (std::size_t j = 0; j < coarse.nodes.size(); ++j) {
          const double half_b = 0.5 * (breaks[b + 1] - breaks[b]),
                       weight = half_a * half_b * coarse.weights[i] * coarse.weights[j];
          const auto value = sample(breaks[b] + half_b * (1 + coarse.nodes[j]), psi);
          for (std::size_t k = 0; k < N; ++k) size[k] += weight * std::fabs(value[k]);
        }
      }
    }
  }
  for (std::size_t k = 0; k < N; ++k) scale[k] = size[k] > 0 ? 1 / size[k] : 1.0;

  bool all_converged = true;
  QuadratureOptions outer, inner;
  outer.relative = inner.relative = 0;
  outer.max_intervals = inner.max_intervals = 200;  // kinks of clamped masking would be refined for ever
  outer.absolute = tolerance;
  inner.absolute = 0.02 * tolerance;  // of 2 pi azimuths
  const auto arc = [&](double psi) {
    polar.PolarBreaks(psi, &breaks);
    const auto result = IntegrateAdaptive<N>([&](double beta) { return sample(beta, psi); }, breaks, inner);
    all_converged = all_converged && result.converged;
    return result.value;
  };
  const auto result = IntegrateAdaptive<N>(arc, azimuths, outer);
  if (converged != nullptr) *converged = all_converged && result.converged;
  std::array<double, N> integral = result.value;
  for (std::size_t k = 0; k < N; ++k) integral[k] /= scale[k];
  return integral;
}

}  // namespace lobefit
