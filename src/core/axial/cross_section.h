// Cross-sections of normal distributions that depend on the polar angle only, [dEon]: sigma(u) = int D(m) max(0, m.w)
// dm over the sphere, with u = cos of the angle between w and the axis n. The projected area of the micro surface that
// a direction sees; G1 = u / sigma.
//
// Normalisations differ by family, as the papers have them (MATH.md section 0):
//   sphere:         int D dm = 1 over the sphere, D in 1/sr - ring, Kagiwada-Kalaba, spherical Gaussian;
//                   isotropic limit sigma = 1/4
//   projected area: int D (m.n) dm = 1                      - Beckmann, GGX; sigma(1) = 1
// [dEon]'s "printed" form of ring and Kagiwada-Kalaba uses int D du = 1 and is 2 pi times the sphere form.
// axial_ndf.h has the distributions themselves, all normalised by projected area.
//
// Every u in [-1, 1]. A null derivative is skipped; the value is the same bits either way. No clamps.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "lobefit/math/quadrature.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// Ring of normals at the cosine u_n, D = delta(u - u_n) / (2 pi): [dEon] eq 8 / (2 pi) with the missing case (0 where
// u u_n < 0 and u^2 + u_n^2 >= 1), as (g + u u_n atan2(g, -u u_n)) / pi inside the band, g^2 = 1 - u^2 - u_n^2 > 0;
// the printed acos costs 1e-10 at the band's edge. Symmetric: sigma(u, u_n) = sigma(u_n, u). u_n = 1 is the flat
// surface, max(0, u) (eq 7). Continuous with continuous first derivatives except at u = u_n = 0 and for the flat
// surface (a kink at u = 0).
double RingCrossSection(double u, double u_n, double* dsigma_du = nullptr, double* dsigma_du_n = nullptr);

// The three parts of 2 pi sigma_ring that [dEon] eq 9-12 integrate one by one: sum = 2 pi RingCrossSection.
struct RingParts {
  double sigma1, sigma2, sigma3;
};
RingParts RingCrossSectionParts(double u, double u_n);

// D(u) = u^p per steradian, p >= 0: [dEon] eq 16-18 (18 corrected to (u^2 - 1)^(p/2+1)) and Table 1 with its lost
// absolute values. The total is 2 pi u / (p + 2) for odd p and a polynomial of degree p in u for even p.
RingParts MonomialCrossSectionParts(int p, double u);
// D(u) = sum_p coefficients[p] u^p per steradian. Summed in Legendre polynomials, whose coefficients of u^p are all
// positive, so that high powers do not cancel as the expanded polynomial would. `dsigma_dcoefficients`, if not null,
// receives sigma of each monomial.
double PolynomialCrossSection(const std::vector<double>& coefficients, double u, double* dsigma_du = nullptr,
                              std::vector<double>* dsigma_dcoefficients = nullptr);

// Beckmann of roughness alpha > 0, projected-area normalisation: [dEon] eq 22 with the exponent's sign corrected to
// -a^2, a = u / (alpha sqrt(1-u^2)); for u < 0 by erfcx, where 1 + erf(a) would lose all digits. Relative error about 2
// a^2 eps there.
double BeckmannCrossSection(double alpha, double u, double* dsigma_dalpha = nullptr, double* dsigma_du = nullptr);

// GGX of roughness alpha > 0, projected-area normalisation: [dEon] eq 25; for u < 0 in the rationalised form.
double GgxCrossSection(double alpha, double u, double* dsigma_dalpha = nullptr, double* dsigma_du = nullptr);

// Kagiwada-Kalaba D = b / (4 pi (1 - b u) atanh b), 0 < b < 1, sphere normalisation: [dEon] eq 27 corrected / (2 pi),
// in the form of MATH.md section 7: even part ((1 - w) + |u| t) / (2 b atanh b), odd part u (1/b - 1/atanh b) / 2, w^2
// = 1 - b^2 (1 - u^2).
double KagiwadaKalabaCrossSection(double b, double u, double* dsigma_db = nullptr, double* dsigma_du = nullptr);

// Any distribution: [dEon] eq 15 by adaptive quadrature over the rings. `distribution`(u_n, 1 - u_n) returns D per
// steradian (sphere or any other normalisation; sigma has the same) and, in further components, its derivatives by
// parameters; the second argument is exact near the axis. value[0] = sigma, value[1...N-1] = its derivatives by those
// parameters, value[N] = dsigma/du. Peaks as narrow as 1e-4 radians at the axis are found without a hint.
template <std::size_t N, class F>
QuadratureResult<N + 1> AxialCrossSection(const F& distribution, double u, const QuadratureOptions& options = {}) {
  constexpr double kTiny = 1e-300;
  const double band = std::sqrt((1 - u) * (1 + u));
  // Over the distance d = 1 -+ u_n from either end, with breaks at powers of 4 and where the direction enters the band.
  const auto half = [&](double sign) {
    std::vector<double> breaks = {0};
    for (double d = std::ldexp(1.0, -32); d < 1; d *= 4) breaks.push_back(d);
    breaks.push_back(1);
    breaks.push_back(u * u / (1 + band));  // 1 - band
    std::sort(breaks.begin(), breaks.end());
    const auto f = [&](double d) {
      const double u_n = sign * (1 - d);
      const std::array<double, N> value = distribution(u_n, sign > 0 ? d : 2 - d);
      double du = 0;
      const double ring = 2 * kPi * RingCrossSection(u, u_n, &du);
      std::array<double, N + 1> result;
      for (std::size_t i = 0; i < N; ++i) result[i] = ring * value[i];
      result[N] = 2 * kPi * du * value[0];
      return result;
    };
    return IntegrateAdaptive<N + 1>(f, breaks, options);
  };
  QuadratureResult<N + 1> result = half(1);
  const QuadratureResult<N + 1> lower = half(-1);
  for (std::size_t i = 0; i <= N; ++i) {
    result.value[i] += lower.value[i];
    result.error[i] += lower.error[i];
  }
  result.converged = result.converged && lower.converged;
  // At the poles the band has shrunk to the equator, where dsigma_ring/du grows without bound; its limit there is -pi/2
  // (D(0+) + D(0-)) u.
  if (band == 0) result.value[N] -= 0.5 * kPi * u * (distribution(kTiny, 1)[0] + distribution(-kTiny, 1)[0]);
  return result;
}

// Definitions for any scalar, the oracle of the tests.
template <class T>
T BeckmannCrossSectionFormula(const T& alpha, const T& u) {
  using std::erf;
  using std::exp;
  using std::sqrt;
  const T s = sqrt((1.0 - u) * (1.0 + u));
  const T a = u / (alpha * s);
  return 0.5 * (u * (1.0 + erf(a)) + alpha * s * exp(-a * a) / std::sqrt(kPi));
}

template <class T>
T GgxCrossSectionFormula(const T& alpha, const T& u) {
  using std::sqrt;
  return 0.5 * (u + sqrt(u * u + alpha * alpha * (1.0 - u) * (1.0 + u)));
}

template <class T>
T KagiwadaKalabaCrossSectionFormula(const T& b, const T& u) {
  using std::log;
  using std::sqrt;
  const T log_ratio = log((1.0 + b) / (1.0 - b));
  const T w = sqrt(1.0 - b * b * (1.0 - u * u));
  return (1.0 - b * u - w + u * log((w + u) / ((1.0 - b) * (1.0 + u)))) / (b * log_ratio);
}

template <class T>
T RingCrossSectionFormula(const T& u, const T& u_n) {
  using std::acos;
  using std::sqrt;
  const T t = u * u_n, s = sqrt((1.0 - u * u) * (1.0 - u_n * u_n));
  if (t >= s) return t;
  if (t <= -s) return 0.0 * t;
  return (sqrt(s * s - t * t) + t * acos(-t / s)) / kPi;
}

}  // namespace lobefit
