#include "lobefit/core/axial/cross_section_sg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "lobefit/core/axial/cross_section.h"
#include "lobefit/core/axial/store.h"
#include "lobefit/math/special.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

// k = 2 / alpha^2 and dk / dalpha.
struct Sharpness {
  explicit Sharpness(double alpha) : k(2 / (alpha * alpha)), dk_dalpha(-4 / (alpha * alpha * alpha)) {}
  double k, dk_dalpha;
};

// From here down the closed form of the odd part and the quadrature of the rest (exp(-2k) < 1e-19 is dropped there).
constexpr double kQuadratureBelow = 0.3;

// Made once, constant afterwards.
const QuadratureRule& Rule() {
  static const QuadratureRule rule = GaussLegendre(48);
  return rule;
}

// sigma(-v), v in [0, 1], for large k, and its derivatives by k and v: eq 29 with xi = cos^2 of the angle x from the
// equator,
//   sigma = k / (1 - e^-2k) int_0^(pi/2) sin x cos x exp(-2 k sin^2((x + d)/2)) I0e(k cos d cos x) dx,  sin d = v,
// all of it positive and decaying, so that the tail keeps its relative accuracy.
double TailByQuadrature(double k, double v, double* dk, double* dv) {
  const double d = std::asin(std::fmin(v, 1.0)), cos_d = std::sqrt((1 - v) * (1 + v));
  // The exponent falls by 50 and more from x = 0 to here: k (v x + cos d x^2 / 2) = 60, and sin x > 0.84 x below 1.
  const double reach = std::fmin(0.5 * kPi, 120 / (k * (v + std::sqrt(v * v + 120 * cos_d / k))));
  double sum = 0, sum_k = 0, sum_v = 0;
  const QuadratureRule& rule = Rule();
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double x = 0.5 * reach * (1 + rule.nodes[i]);
    const double sin_x = std::sin(x), cos_x = std::cos(x), half = std::sin(0.5 * (x + d));
    const double q = k * cos_d * cos_x;
    const ScaledBesselI bessel = BesselIScaled(q);
    const double weight = rule.weights[i] * sin_x * cos_x * std::exp(-2 * k * half * half);
    sum += weight * bessel.i0;
    // d/dk of exp(-k - k v sin x) I0(q), with 1 + v sin x - cos d cos x = 2 sin^2((x + d)/2).
    sum_k -= weight * (2 * half * half * bessel.i0 + cos_d * cos_x * bessel.i0_minus_i1);
    const double i1_over_q = q > 0 ? bessel.i1 / q : 0.5;
    sum_v -= weight * k * (sin_x * bessel.i0 + v * k * cos_x * cos_x * i1_over_q);
  }
  const double factor = 0.5 * reach * k;
  Store(dk, factor * (sum_k + sum / k));
  Store(dv, factor * sum_v);
  return factor * sum;
}

// The sum over Legendre polynomials up to degree l_max, and its derivatives by k and u.
double HarmonicSum(double k, double u, int l_max, double* dk, double* du) {
  std::vector<double> rho, drho;
  SphericalBesselRatios(k, l_max, &rho, dk != nullptr ? &drho : nullptr);
  double c = rho[1], dc = dk != nullptr ? drho[1] : 0;
  double sum = 0.25 + 0.5 * c * u, sum_k = 0.5 * dc * u, sum_u = 0.5 * c;
  double p_before = 1, p = u, d_before = 0, d = 1;
  double g = 0.5;  // int_0^1 x P_l(x) dx for even l
  for (int l = 2; l <= l_max; ++l) {
    const double p_next = ((2 * l - 1) * u * p - (l - 1) * p_before) / l;
    const double d_next = d_before + (2 * l - 1) * p;
    p_before = p;
    d_before = d;
    p = p_next;
    d = d_next;
    if (dk != nullptr) dc = dc * rho[l] + c * drho[l];
    c *= rho[l];
    if (l % 2 != 0) continue;
    g *= -static_cast<double>(l - 3) / (l + 2);
    const double weight = 0.5 * (2 * l + 1) * g;
    sum += weight * c * p;
    sum_k += weight * dc * p;
    sum_u += weight * c * d;
  }
  Store(dk, sum_k);
  Store(du, sum_u);
  return sum;
}

int FullDegree(double k) { return static_cast<int>(std::sqrt(80 * k)) + 24; }

// Measured maxima of |approximation - SgCrossSection| over 12001 cosines, at alpha = 0.01 * 300^(i/32), i = 0 ... 32.
constexpr double kFirstAlpha = 0.01, kLastAlpha = 3;
constexpr int kMeasured = 33;
constexpr std::array<double, kMeasured> kErrorBeckmann = {
    5e-05,    7.142e-05, 0.000102, 0.0001457, 0.0002081, 0.0002972, 0.0004245, 0.0006063, 0.000866, 0.001237, 0.001767,
    0.002523, 0.003604,  0.005148, 0.007353,  0.0105,    0.015,     0.02142,   0.0306,    0.04371,  0.06243,  0.08916,
    0.1273,   0.1811,    0.2539,   0.343,     0.4367,    0.5209,    0.5876,    0.6366,    0.6713,   0.6954,   0.7467};
constexpr std::array<double, kMeasured> kErrorEq40 = {
    6.031e-08, 1.029e-07, 1.757e-07, 3e-07,     5.121e-07, 8.741e-07, 1.492e-06, 2.547e-06, 4.348e-06,
    7.421e-06, 1.267e-05, 2.162e-05, 3.691e-05, 6.301e-05, 0.0001076, 0.0001836, 0.0003134, 0.0005351,
    0.0009135, 0.00156,   0.002665,  0.004555,  0.00778,   0.01304,   0.02199,   0.03929,   0.06857,
    0.1128,    0.1731,    0.25,      0.3446,    0.4592,    0.5968};
constexpr std::array<double, kMeasured> kErrorEq41 = {
    4.147e-12, 1.011e-11, 2.465e-11, 6.009e-11, 1.465e-10, 3.571e-10, 8.704e-10, 2.121e-09, 5.17e-09,
    1.26e-08,  3.068e-08, 7.469e-08, 1.817e-07, 4.418e-07, 1.073e-06, 2.6e-06,   6.289e-06, 1.517e-05,
    3.643e-05, 8.713e-05, 0.0002075, 0.0004935, 0.001189,  0.003072,  0.009395,  0.02407,   0.04872,
    0.083,     0.1204,    0.1534,    0.1797,    0.1995,    0.2141};

// Interpolated in the logarithms; below the first alpha the error falls as alpha^power, or stays at the rounding of the
// reference.
double MeasuredError(const std::array<double, kMeasured>& table, double power, double alpha) {
  if (!(alpha <= kLastAlpha)) return std::numeric_limits<double>::infinity();
  constexpr double kMargin = 1.05, kRounding = 2e-15;
  if (alpha < kFirstAlpha) return kMargin * table[0] * std::pow(alpha / kFirstAlpha, power) + kRounding;
  const double position = std::log(alpha / kFirstAlpha) / std::log(kLastAlpha / kFirstAlpha) * (kMeasured - 1);
  const int i = std::clamp(static_cast<int>(position), 0, kMeasured - 2);
  const double t = position - i;
  return kMargin * std::exp((1 - t) * std::log(table[i]) + t * std::log(table[i + 1])) + kRounding;
}

// For l = 0 ... full degree: an upper bound of the terms of degree above l, sum of (2j+1)/2 c_j |g_j| (|P_j| <= 1),
// plus the rounding.
std::vector<double> HarmonicErrors(double k) {
  // For very large k the terms fall like l^(-3/2) for long; past degree kCut their sum is bounded by the last one times
  // its degree.
  constexpr int kCut = 4096;
  const bool cut = std::sqrt(80 * k) > kCut;
  const int last = cut ? kCut : FullDegree(k);
  std::vector<double> rho, term(last + 2, 0.0);
  SphericalBesselRatios(k, last + 1, &rho);
  double c = 1, g = 0.5;
  for (int l = 1; l <= last + 1; ++l) {
    c *= rho[l];
    if (l % 2 == 0) g *= static_cast<double>(l - 3) / (l + 2);
    if (l % 2 == 0 || l == 1) term[l] = 0.5 * (2 * l + 1) * c * (l == 1 ? 1.0 / 3 : std::fabs(g));
  }
  std::vector<double> error(last + 1);
  double sum = cut ? 0.5 * (2 * last + 1) * std::fabs(g) * last : 1e-15;
  for (int l = last; l >= 0; --l) error[l] = sum += term[l + 1];
  return error;
}

// Nanoseconds that one value took, measured on a 2020s x86-64 core; only their order matters.
double Cost(const SgForm& form, double alpha) {
  const double k = Sharpness(alpha).k;
  switch (form.kind) {
    case SgForm::kBeckmann:
      return 50;
    case SgForm::kEq40:
      return 80;
    case SgForm::kEq41:
      return 250;
    case SgForm::kHarmonics:
      if (k > 2.0 * form.l_max * form.l_max) return 40 + 10 * form.l_max;
      return 100 + 6 * (2 * form.l_max + std::sqrt(45 * k));
    case SgForm::kExact:
      break;
  }
  return alpha < kQuadratureBelow ? 5000 : 100 + 6 * (3 * std::sqrt(80 * k) + 48);
}

}  // namespace

double SgCrossSection(double alpha, double u, double* dsigma_dalpha, double* dsigma_du) {
  const Sharpness sharpness(alpha);
  const double k = sharpness.k;
  double dk = 0;
  double* dk_pointer = dsigma_dalpha != nullptr ? &dk : nullptr;
  double sigma = 0;
  if (alpha >= kQuadratureBelow) {
    sigma = HarmonicSum(k, u, FullDegree(k), dk_pointer, dsigma_du);
  } else {
    double dv = 0, slope = 0;
    sigma = TailByQuadrature(k, std::fabs(u), dk_pointer, &dv);
    Store(dsigma_du, -dv);
    if (u > 0) {
      // sigma(u) - sigma(-u) = u L(k)
      const double langevin = Langevin(k, &slope);
      sigma += u * langevin;
      dk += u * slope;
      Store(dsigma_du, langevin + dv);
    }
  }
  Store(dsigma_dalpha, dk * sharpness.dk_dalpha);
  return sigma;
}

double SgCrossSectionOdd(double alpha, double u, double* dsigma_dalpha, double* dsigma_du) {
  const Sharpness sharpness(alpha);
  double slope = 0;
  const double langevin = Langevin(sharpness.k, &slope);
  Store(dsigma_dalpha, 0.5 * u * slope * sharpness.dk_dalpha);
  Store(dsigma_du, 0.5 * langevin);
  return 0.5 * u * langevin;
}

double SgCrossSection2(double alpha, double u, double* dsigma_dalpha, double* dsigma_du) {
  // (R/2) csch(k) I1(k R), R = sqrt(1 - u^2)
  const Sharpness sharpness(alpha);
  const double k = sharpness.k, r = std::sqrt((1 - u) * (1 + u));
  const ScaledBesselI bessel = BesselIScaled(k * r);
  const double scale = -std::exp(-k * u * u / (1 + r)) / std::expm1(-2 * k);
  if (dsigma_dalpha != nullptr) {
    const double slope = r * scale * (0.5 * r * (bessel.i0 + bessel.i2) - bessel.i1 / std::tanh(k));
    *dsigma_dalpha = slope * sharpness.dk_dalpha;
  }
  Store(dsigma_du, -u * k * bessel.i0 * scale);
  return r * bessel.i1 * scale;
}

double SgCrossSectionEq40(double alpha, double u, double* dsigma_dalpha, double* dsigma_du) {
  // As printed, with tanh(k/2) + coth(k/2) = 2 coth(k) and 2 coth(k) - m^2 = 2 L(k): no large terms are left to cancel
  // for large alpha.
  const Sharpness sharpness(alpha);
  const double k = sharpness.k;
  double slope = 0;
  const double langevin = Langevin(k, &slope);
  const double tanh_half = std::tanh(0.5 * k), h = tanh_half / k;
  const double beckmann = BeckmannCrossSection(alpha, u, dsigma_dalpha, dsigma_du);
  if (dsigma_dalpha != nullptr) {
    const double h_slope = (0.5 * (1 - tanh_half) * (1 + tanh_half) - h) / k;
    *dsigma_dalpha += 0.5 * (u * slope - std::fabs(u) * h_slope) * sharpness.dk_dalpha;
  }
  if (dsigma_du != nullptr) *dsigma_du += 0.5 * (langevin - 1 - (u < 0 ? -h : h));
  // Behind, 1 - L - h = 2 (1/k - 1/(e^k - 1)) / (e^k + 1), which like Beckmann's tail keeps its relative accuracy.
  if (u < 0) return beckmann - u * (1 / k - 1 / std::expm1(k)) / (std::exp(k) + 1);
  return beckmann + 0.5 * u * (langevin - 1 - h);
}

double SgCrossSectionEq41(double alpha, double u, double* dsigma_dalpha, double* dsigma_du) {
  const Sharpness sharpness(alpha);
  const double k = sharpness.k;
  double slope = 0;
  const double t = 2 * Langevin(k, &slope);
  const ScaledBesselI bessel = BesselIScaled(k);
  const double scale = -2 / std::expm1(-2 * k);
  const double c0 = bessel.i0 * scale, c1 = bessel.i1 * scale, c2 = bessel.i2 * scale;  // csch(k) I_n(k)
  const double s = c0 + c2, b = 4 / k * (c1 - c2 / k);
  const double w = b * t * t - kPi * s * s * s;
  const double linear = 0.5 * kSqrtPi * s * k / t, cubic = -kSqrtPi * k * k * k * w / (24 * t * t * t);
  const double z = u * (linear + cubic * u * u);  // A - B
  const double front = std::erfc(-z), gauss = 2 / kSqrtPi * std::exp(-z * z);
  double band_alpha = 0, band_u = 0;
  const double band = SgCrossSection2(alpha, u, dsigma_dalpha != nullptr ? &band_alpha : nullptr,
                                      dsigma_du != nullptr ? &band_u : nullptr);
  if (dsigma_dalpha != nullptr) {
    const double coth = 1 / std::tanh(k), dt = 2 * slope;
    const double dc0 = c1 - coth * c0, dc1 = 0.5 * s - coth * c1, dc2 = c1 - 2 * c2 / k - coth * c2;
    const double ds = dc0 + dc2, db = -b / k + 4 / k * (dc1 - dc2 / k + c2 / (k * k));
    const double dw = db * t * t + 2 * b * t * dt - 3 * kPi * s * s * ds;
    const double dlinear = linear * (ds / s + 1 / k - dt / t);
    const double dcubic = cubic * (3 / k - 3 * dt / t) - kSqrtPi * k * k * k * dw / (24 * t * t * t);
    const double dz = u * (dlinear + dcubic * u * u);
    *dsigma_dalpha = 0.25 * u * (dt * front + t * gauss * dz) * sharpness.dk_dalpha + band_alpha;
  }
  if (dsigma_du != nullptr) {
    *dsigma_du = 0.25 * t * (front + u * gauss * (linear + 3 * cubic * u * u)) + band_u;
  }
  return 0.25 * t * u * front + band;
}

double SgCrossSectionHarmonics(double alpha, double u, int l_max, double* dsigma_dalpha, double* dsigma_du) {
  const Sharpness sharpness(alpha);
  double dk = 0;
  const double sigma = HarmonicSum(sharpness.k, u, l_max, dsigma_dalpha != nullptr ? &dk : nullptr, dsigma_du);
  Store(dsigma_dalpha, dk * sharpness.dk_dalpha);
  return sigma;
}

double SgCrossSection(const SgForm& form, double alpha, double u, double* dsigma_dalpha, double* dsigma_du) {
  switch (form.kind) {
    case SgForm::kHarmonics:
      return SgCrossSectionHarmonics(alpha, u, form.l_max, dsigma_dalpha, dsigma_du);
    case SgForm::kBeckmann:
      return BeckmannCrossSection(alpha, u, dsigma_dalpha, dsigma_du);
    case SgForm::kEq40:
      return SgCrossSectionEq40(alpha, u, dsigma_dalpha, dsigma_du);
    case SgForm::kEq41:
      return SgCrossSectionEq41(alpha, u, dsigma_dalpha, dsigma_du);
    case SgForm::kExact:
      break;
  }
  return SgCrossSection(alpha, u, dsigma_dalpha, dsigma_du);
}

double SgFormError(const SgForm& form, double alpha) {
  switch (form.kind) {
    case SgForm::kHarmonics: {
      const std::vector<double> error = HarmonicErrors(Sharpness(alpha).k);
      return error[std::min<std::size_t>(static_cast<std::size_t>(std::max(form.l_max, 0)), error.size() - 1)];
    }
    case SgForm::kBeckmann:
      return MeasuredError(kErrorBeckmann, 2, alpha);
    case SgForm::kEq40:
      return MeasuredError(kErrorEq40, 3, alpha);
    case SgForm::kEq41:
      return MeasuredError(kErrorEq41, 5, alpha);
    case SgForm::kExact:
      break;
  }
  return 2e-15;
}

SgForm CheapestSgForm(double alpha, double max_error) {
  SgForm best = {SgForm::kExact, 0};
  const auto offer = [&](const SgForm& form) {
    if (Cost(form, alpha) < Cost(best, alpha)) best = form;
  };
  for (const SgForm::Kind kind : {SgForm::kBeckmann, SgForm::kEq40, SgForm::kEq41}) {
    if (SgFormError({kind, 0}, alpha) <= max_error) offer({kind, 0});
  }
  const std::vector<double> error = HarmonicErrors(Sharpness(alpha).k);
  for (int l_max = 1; l_max < static_cast<int>(error.size()); ++l_max) {
    if (error[l_max] > max_error) continue;
    offer({SgForm::kHarmonics, l_max});
    break;
  }
  return best;
}

}  // namespace lobefit
