#include "lobefit/math/special.h"

#include <cmath>

#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

constexpr double kTwoOverSqrtPi = 1.12837916709551257389615890312154517;

// exp(x^2) with the rounding of x^2 taken into account, which would otherwise cost x^2 units in the last place.
double ExpSquare(double x) {
  const double square = x * x;
  const double rest = std::fma(x, x, -square);
  const double e = std::exp(square);
  return e + e * rest;
}

// sqrt(2 pi x) exp(-x) I_n(x) - 1, mu = 4 n^2, by the large-argument expansion (Abramowitz and Stegun 9.7.1); x >= 25.
double HankelSumLessOne(double mu, double x) {
  double term = 1, sum = 0;
  for (int j = 1; j < 60; ++j) {
    const double odd = 2 * j - 1;
    const double next = -term * (mu - odd * odd) / (8 * j * x);
    if (std::fabs(next) >= std::fabs(term) && j > 3) break;
    term = next;
    sum += term;
    if (std::fabs(term) < 1e-18) break;
  }
  return sum;
}

}  // namespace

double Erfcx(double x) {
  if (x < 10) return x > -27 ? ExpSquare(x) * std::erfc(x) : 2 * std::exp(x * x);
  // Asymptotic series 1/(x sqrt(pi)) sum (-1)^j (2j-1)!! / (2 x^2)^j; its smallest term at x = 10 is far below the
  // rounding.
  const double step = 0.5 / (x * x);
  double term = 1, sum = 1;
  for (int j = 1; j < 40; ++j) {
    term *= -(2 * j - 1) * step;
    sum += term;
    if (std::fabs(term) < 1e-18) break;
  }
  return 0.5 * kTwoOverSqrtPi * sum / x;
}

double Langevin(double x, double* derivative) {
  const double a = std::fabs(x);
  if (a < 1) {
    // Continued fraction x/(3 + x^2/(5 + x^2/(7 + ...))) and its derivative, evaluated from the tail.
    const double square = a * a;
    double tail = 0, tail_derivative = 0;  // tail_j = 1 / (2j + 1 + x^2 tail_{j+1})
    for (int j = 12; j >= 1; --j) {
      const double next = 1 / (2 * j + 1 + square * tail);
      tail_derivative = -next * next * (2 * a * tail + square * tail_derivative);
      tail = next;
    }
    if (derivative != nullptr) *derivative = tail + a * tail_derivative;
    return x * tail;
  }
  const double e = std::exp(-2 * a);  // coth = (1 + e) / (1 - e)
  const double one_minus_e = -std::expm1(-2 * a);
  if (derivative != nullptr) *derivative = 1 / (a * a) - 4 * e / (one_minus_e * one_minus_e);
  return std::copysign((1 + e) / one_minus_e - 1 / a, x);
}

ScaledBesselI BesselIScaled(double x) {
  const double a = std::fabs(x);
  ScaledBesselI result{};
  if (a == 0) {
    result = {1, 0, 0, 1};
  } else if (a >= 25) {
    const double factor = 1 / std::sqrt(2 * kPi * a);
    const double h0 = HankelSumLessOne(0, a), h1 = HankelSumLessOne(4, a), h2 = HankelSumLessOne(16, a);
    result = {factor + factor * h0, factor + factor * h1, factor + factor * h2, factor * (h0 - h1)};
  } else {
    // Miller: downward recurrence from an order where I_n is negligible, scaled by exp(x) = I_0 + 2 sum I_n. All terms
    // are positive.
    const int start = 24 + static_cast<int>(std::sqrt(90 * a)) + static_cast<int>(a / 2);
    double upper = 0, current = 1e-290, sum = 0;
    for (int n = start; n >= 1; --n) {
      const double lower = upper + 2 * n / a * current;
      sum += 2 * current;
      upper = current;
      current = lower;
      if (n == 3) result.i2 = current;
      if (current > 1e200) {
        current *= 1e-290;
        upper *= 1e-290;
        sum *= 1e-290;
        result.i2 *= 1e-290;
      }
    }
    sum += current;
    result = {current / sum, upper / sum, result.i2 / sum, (current - upper) / sum};
  }
  if (x < 0) result.i1 = -result.i1;
  return result;
}

void SphericalBesselRatios(double k, int l_max, std::vector<double>* rho, std::vector<double>* derivative) {
  rho->assign(l_max + 1, 0.0);
  if (derivative != nullptr) derivative->assign(l_max + 1, 0.0);
  if (k > 25.0 * l_max * l_max / 16 && k > 4) {
    // Few orders of a large argument: upwards, where an error grows by 1/rho^2 a step, exp(l_max^2 / k) in all.
    double dr = 0, r = Langevin(k, &dr);
    for (int l = 1; l <= l_max; ++l) {
      (*rho)[l] = r;
      if (derivative != nullptr) (*derivative)[l] = dr;
      const double q = (2 * l + 1) / k;
      dr = q / k - dr / (r * r);
      r = 1 / r - q;
    }
    return;
  }
  // The error of the starting guess 0 shrinks by rho^2 at every step down.
  const int start = l_max + 14 + static_cast<int>(std::sqrt(45 * k));
  double r = 0, dr = 0;
  for (int l = start; l >= 1; --l) {
    const double q = (2 * l + 1) / k;
    const double next = 1 / (q + r);
    dr = next * next * (q / k - dr);
    r = next;
    if (l <= l_max) {
      (*rho)[l] = r;
      if (derivative != nullptr) (*derivative)[l] = dr;
    }
  }
}

double XMinusSin(double x) {
  if (std::fabs(x) > 1) return x - std::sin(x);
  const double square = x * x;
  double term = x * square / 6, sum = term;
  for (int j = 4; std::fabs(term) > 1e-18 * std::fabs(sum); j += 2) {
    term *= -square / (j * (j + 1));
    sum += term;
  }
  return sum;
}

double AtanhMinusX(double x) {
  if (std::fabs(x) > 0.5) return std::atanh(x) - x;
  const double square = x * x;
  double power = x * square, sum = power / 3;
  for (int j = 5; std::fabs(power) > 1e-18 * std::fabs(sum); j += 2) {
    power *= square;
    sum += power / j;
  }
  return sum;
}

double OneMinusCos(double x) {
  const double s = std::sin(0.5 * x);
  return 2 * s * s;
}

double GammaHalfRatio(double x, double* dlog) {
  // Up to z >= 16 by Gamma(z + 1) = z Gamma(z), then Stirling's series of the quotient; its next term is below 1e-17.
  double factor = 1, dlog_factor = 0, z = x;
  for (; z < 16; z += 1) {
    factor *= z / (z + 0.5);
    dlog_factor += 0.5 / (z * (z + 0.5));
  }
  constexpr double kSeries[] = {-1.0 / 8, 1.0 / 192, -1.0 / 640, 17.0 / 14336, -31.0 / 18432, 691.0 / 180224};
  const double inverse = 1 / z, square = inverse * inverse;
  double sum = 0, slope = 0, power = inverse;
  for (int k = 0; k < 6; ++k) {
    sum += kSeries[k] * power;
    slope -= (2 * k + 1) * kSeries[k] * power * inverse;
    power *= square;
  }
  if (dlog != nullptr) *dlog = 0.5 * inverse + slope + dlog_factor;
  return factor * std::sqrt(z) * std::exp(sum);
}

}  // namespace lobefit
