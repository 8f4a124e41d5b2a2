#include "lobefit/core/axial/cross_section.h"

#include "lobefit/core/axial/store.h"
#include "lobefit/math/special.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

// 1 - x^2 - y^2 with one rounding: squares and sums with their errors, so that the edge of the band (where the result
// is 0) is as exact as the inputs.
double OneMinusSquares(double x, double y) {
  const double xx = x * x, yy = y * y;
  const double x_error = std::fma(x, x, -xx), y_error = std::fma(y, y, -yy);
  const double large = std::fmax(xx, yy), small = std::fmin(xx, yy);
  const double first = 1 - large, first_error = (1 - first) - large;
  const double second = first - small;
  const double part = second - first;
  const double second_error = (first - (second - part)) - (small + part);
  return second + (first_error + second_error - x_error - y_error);
}

}  // namespace

double RingCrossSection(double u, double u_n, double* dsigma_du, double* dsigma_du_n) {
  const double product = u * u_n;
  const double square = OneMinusSquares(u, u_n);
  if (square <= 0) {
    // The whole ring is seen from its front or from its back.
    const bool front = product > 0;
    Store(dsigma_du, front ? u_n : 0);
    Store(dsigma_du_n, front ? u : 0);
    return front ? product : 0;
  }
  const double g = std::sqrt(square);
  const double angle = std::atan2(g, -product);
  Store(dsigma_du, (u_n * angle - g * u / ((1 - u) * (1 + u))) * kInvPi);
  Store(dsigma_du_n, (u * angle - g * u_n / ((1 - u_n) * (1 + u_n))) * kInvPi);
  // Behind the ring's plane the two terms nearly cancel towards the band's edge: g - |p| phi with tan(phi) = g / |p|.
  if (product < 0 && g < -0.5 * product) {
    const double x = g / -product;
    double power = -product * x, sum = 0;  // |p| (x - atan x) = |p| (x^3/3 - x^5/5 + ...)
    for (int j = 3; std::fabs(power) > 1e-18 * std::fabs(sum); j += 2) {
      power *= -x * x;
      sum -= power / j;
    }
    return sum * kInvPi;
  }
  return (g + product * angle) * kInvPi;
}

RingParts RingCrossSectionParts(double u, double u_n) {
  const double product = u * u_n, square = OneMinusSquares(u, u_n);
  RingParts parts{product > 0 ? 2 * kPi * product : 0, 0, 0};
  if (square > 0) {
    const double g = std::sqrt(square);
    parts.sigma2 = 2 * g;
    parts.sigma3 = 2 * product * std::atan2(g, -product) - parts.sigma1;
  }
  return parts;
}

RingParts MonomialCrossSectionParts(int p, double u) {
  if (p % 2 != 0) return {2 * kPi * u / (p + 2), 0, 0};
  RingParts parts{2 * kPi * std::fabs(u) / (p + 2), 0, 0};
  // Table 1: pi binomial(p, p/2) 2^-p / (p/2 + 1) (1 - u^2)^(p/2 + 1)
  const double square = (1 - u) * (1 + u);
  double sigma2 = kPi * square;
  for (int j = 1; j <= p / 2; ++j) sigma2 *= square * (2 * j - 1) / (2 * j + 2);
  parts.sigma2 = sigma2;
  std::vector<double> coefficients(p + 1, 0.0);
  coefficients[p] = 1;
  parts.sigma3 = PolynomialCrossSection(coefficients, u) - parts.sigma1 - parts.sigma2;
  return parts;
}

double PolynomialCrossSection(const std::vector<double>& coefficients, double u, double* dsigma_du,
                              std::vector<double>* dsigma_dcoefficients) {
  const int n = static_cast<int>(coefficients.size());
  // The clamped cosine takes P_l to 2 pi g_l P_l(u), g_l = int_0^1 x P_l(x) dx.
  std::vector<double> term(std::max(n, 2), 0.0), slope(std::max(n, 2), 0.0);
  double p_before = 1, p = u, d_before = 0, d = 1, g = 0.5;
  term[0] = kPi;
  term[1] = 2 * kPi / 3 * u;
  slope[1] = 2 * kPi / 3;
  for (int l = 2; l < n; ++l) {
    const double p_next = ((2 * l - 1) * u * p - (l - 1) * p_before) / l;
    const double d_next = d_before + (2 * l - 1) * p;
    p_before = p;
    d_before = d;
    p = p_next;
    d = d_next;
    if (l % 2 != 0) continue;
    g *= -static_cast<double>(l - 3) / (l + 2);
    term[l] = 2 * kPi * g * p;
    slope[l] = 2 * kPi * g * d;
  }
  if (dsigma_dcoefficients != nullptr) dsigma_dcoefficients->assign(n, 0.0);
  double sigma = 0, derivative = 0;
  for (int power = 0; power < n; ++power) {
    // u^power = sum_l c_l P_l, l = power, power - 2, ...: c_0 = 1/(power+1), c_1 = 3/(power+2), upwards by their ratio.
    // Odd l above 1 add 0.
    double c = power % 2 == 0 ? 1.0 / (power + 1) : 3.0 / (power + 2);
    double monomial = 0, monomial_slope = 0;
    for (int l = power % 2; l <= power; l += 2) {
      monomial += c * term[l];
      monomial_slope += c * slope[l];
      c *= static_cast<double>(2 * l + 5) / (2 * l + 1) * (power - l) / (l + power + 3);
    }
    sigma += coefficients[power] * monomial;
    derivative += coefficients[power] * monomial_slope;
    if (dsigma_dcoefficients != nullptr) (*dsigma_dcoefficients)[power] = monomial;
  }
  Store(dsigma_du, derivative);
  return sigma;
}

double BeckmannCrossSection(double alpha, double u, double* dsigma_dalpha, double* dsigma_du) {
  const double s = std::sqrt((1 - u) * (1 + u));
  if (s == 0) {
    Store(dsigma_dalpha, 0);
    Store(dsigma_du, u > 0 ? 1 : 0);
    return u > 0 ? 1 : 0;
  }
  const double a = u / (alpha * s);
  const double e = std::exp(-a * a);
  // sigma = alpha s phi(a), phi = (a (1 + erf a) + e^(-a^2) / sqrt(pi)) / 2, phi' = (1 + erf a) / 2.
  Store(dsigma_dalpha, 0.5 * kInvSqrtPi * s * e);
  Store(dsigma_du, 0.5 * std::erfc(-a) - 0.5 * kInvSqrtPi * alpha * u * e / s);
  if (u < 0) return 0.5 * alpha * s * e * (kInvSqrtPi + a * Erfcx(-a));
  return 0.5 * (u * (1 + std::erf(a)) + alpha * s * e * kInvSqrtPi);
}

double GgxCrossSection(double alpha, double u, double* dsigma_dalpha, double* dsigma_du) {
  const double square = (1 - u) * (1 + u), alpha2 = alpha * alpha;
  const double w = std::sqrt(u * u + alpha2 * square);
  Store(dsigma_dalpha, 0.5 * alpha * square / w);
  if (dsigma_du != nullptr) {
    // (w + u (1 - alpha^2)) / (2 w); where the two have opposite signs, as a quotient without cancellation.
    const double other = u * (1 - alpha) * (1 + alpha);
    *dsigma_du = other >= 0 ? 0.5 * (w + other) / w : 0.5 * alpha2 * (1 + u * u - alpha2 * u * u) / (w * (w - other));
  }
  return u < 0 ? 0.5 * alpha2 * square / (w - u) : 0.5 * (u + w);
}

double KagiwadaKalabaCrossSection(double b, double u, double* dsigma_db, double* dsigma_du) {
  const double v = std::fabs(u);
  const double b2 = b * b, be = (1 - b) * (1 + b), square = (1 - u) * (1 + u);
  const double w = std::sqrt(be + b2 * u * u);
  const double l = std::atanh(b), delta = AtanhMinusX(b);
  const double one_minus_w = b2 * square / (1 + w);
  const double x = v * b2 / (be + w);  // t = atanh(x) = log((w + v) / ((1 + v) sqrt(be)))
  const double t = b < 0.5 ? std::atanh(x) : std::log((w + v) / (1 + v)) - 0.5 * std::log(be);
  const double numerator = one_minus_w + v * t;
  const double odd = delta / (b * l);  // 1/b - 1/l
  if (dsigma_du != nullptr || dsigma_db != nullptr) {
    const double t_minus_x = b < 0.5 ? AtanhMinusX(x) : t - x;
    if (dsigma_du != nullptr) {
      // d numerator / dv = t - b^2 v / (1 + w)
      const double slope = t_minus_x + b2 * b2 * v / ((be + w) * (1 + w));
      *dsigma_du = std::copysign(slope, u) / (2 * b * l) + 0.5 * odd;
    }
    if (dsigma_db != nullptr) {
      // Even part: (w b^2 l - numerator (be l + b)) / (2 be b^2 l^2). For small b all terms are b^3 and cancel to b^5:
      // with numerator = b^2/2 + rest and l = b + delta the b^3 is taken out beforehand.
      double m = w * b2 * l - numerator * (be * l + b);
      if (b < 0.5) {
        const double rest = 0.5 * b2 * square * one_minus_w / (1 + w) + v * t_minus_x +
                            0.5 * v * v * b2 * (b2 + one_minus_w) / (be + w);
        m = 0.5 * b2 * (delta + b2 * l) - one_minus_w * b2 * l - rest * (be * l + b);
      }
      const double odd_slope = (b2 * b2 - be * delta * (2 * b + delta)) / (b2 * be * l * l);
      *dsigma_db = m / (2 * be * b2 * l * l) + 0.5 * u * odd_slope;
    }
  }
  return numerator / (2 * b * l) + 0.5 * u * odd;
}

}  // namespace lobefit
