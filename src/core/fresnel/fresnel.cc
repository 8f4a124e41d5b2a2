#include "lobefit/core/fresnel/fresnel.h"

#include <algorithm>

#include "lobefit/math/quadrature.h"

namespace lobefit {

double FresnelSchlick(double c, double f0, double* dF_dc, double* dF_df0) {
  const double m = 1.0 - c, m2 = m * m, m4 = m2 * m2, m5 = m4 * m;
  if (dF_dc != nullptr) *dF_dc = -5.0 * (1.0 - f0) * m4;
  if (dF_df0 != nullptr) *dF_df0 = 1.0 - m5;
  return f0 + (1.0 - f0) * m5;
}

namespace {

// w = 1/7 is the cosine at which the tint is said.
constexpr double kEdgeScale = 823543.0 / 46656.0;    // 1 / (w (1 - w)^6) = 7^7 / 6^6
constexpr double kOneMinusEdge5 = 7776.0 / 16807.0;  // (1 - w)^5

}  // namespace

double SchlickF82Coefficient(double f0, double tint) {
  return kEdgeScale * (1.0 - tint) * (f0 + (1.0 - f0) * kOneMinusEdge5);
}

double FresnelSchlickF82(double c, double f0, double tint, SchlickF82Gradient* gradient) {
  const double m = 1.0 - c, m2 = m * m, m4 = m2 * m2, m5 = m4 * m;
  const double edge = kEdgeScale * c * m5 * m, at_edge = f0 + (1.0 - f0) * kOneMinusEdge5;
  if (gradient != nullptr) {
    const double b = SchlickF82Coefficient(f0, tint);
    gradient->dc = -5.0 * (1.0 - f0) * m4 - b * m5 * (1.0 - 7.0 * c);
    gradient->df0 = 1.0 - m5 - (1.0 - tint) * (1.0 - kOneMinusEdge5) * edge;
    gradient->dtint = at_edge * edge;
  }
  return f0 + (1.0 - f0) * m5 - (1.0 - tint) * at_edge * edge;
}

void FresnelCurveBasis(double c, double* basis, double* slope) {
  constexpr double kKnots[] = {0, 0, 0, 0, 0.25, 0.6, 1, 1, 1, 1};
  std::size_t i = 3;
  while (i < kFresnelCurveSize - 1 && c >= kKnots[i + 1]) ++i;
  // The triangle of de Boor and Cox; the slopes are differences of the quadratic splines.
  double N[4] = {1, 0, 0, 0}, quadratic[3] = {0, 0, 0};
  for (std::size_t p = 1; p < 4; ++p) {
    if (p == 3) std::copy(N, N + 3, quadratic);
    double saved = 0;
    for (std::size_t j = 0; j < p; ++j) {
      const double left = kKnots[i - p + 1 + j], right = kKnots[i + 1 + j];
      const double part = N[j] / (right - left);
      N[j] = saved + (right - c) * part;
      saved = (c - left) * part;
    }
    N[p] = saved;
  }
  std::fill(basis, basis + kFresnelCurveSize, 0.0);
  std::copy(N, N + 4, basis + i - 3);
  if (slope == nullptr) return;
  std::fill(slope, slope + kFresnelCurveSize, 0.0);
  for (std::size_t j = 0; j < 3; ++j) {
    const double part = 3.0 * quadratic[j] / (kKnots[i + 1 + j] - kKnots[i - 2 + j]);
    slope[i - 3 + j] -= part;
    slope[i - 2 + j] += part;
  }
}

void FresnelCurveOfSchlick(double f0, double* coefficients) {
  // Minimax for f0 = 0 (MATH.md 8.3).
  constexpr double kSchlick[kFresnelCurveSize] = {1.001385, 0.580863, 0.075146, -0.006957, -0.002188, 0.001385};
  for (std::size_t k = 0; k < kFresnelCurveSize; ++k)
    coefficients[k] = std::clamp(f0 + (1.0 - f0) * kSchlick[k], 0.0, 1.0);
}

double FresnelConductor(double c, const ConductorIndex& index, ConductorFresnelGradient* gradient) {
  const double eta = index.eta, k = index.k;
  const double n2_re = (eta - k) * (eta + k), n2_im = 2.0 * eta * k;
  const double sin2 = (1.0 - c) * (1.0 + c);
  // Re(w^2) as a sum around whichever of eta^2 - 1 and k^2 - c^2 keeps small differences exact.
  const double re = (eta - 1.0) * (eta + 1.0) + (c - k) * (c + k);
  const double modulus = std::hypot(re, n2_im);
  double p, q;
  if (re >= 0) {
    p = std::sqrt(0.5 * (modulus + re));
    q = p > 0 ? 0.5 * n2_im / p : 0.0;
  } else {
    q = std::sqrt(0.5 * (modulus - re));
    p = 0.5 * n2_im / q;
  }
  const double x = n2_re * c, y = n2_im * c;  // n^2 c
  const double s_den = (c + p) * (c + p) + q * q, p_den = (x + p) * (x + p) + (y + q) * (y + q);
  const double rs = ((c - p) * (c - p) + q * q) / s_den;
  const double rp = ((x - p) * (x - p) + (y - q) * (y - q)) / p_den;
  if (gradient != nullptr) {
    const double ww = p * p + q * q;
    // 1 - |r_s|^2 = c ts, 1 - |r_p|^2 = c tp.
    const double ts = 4.0 * p / s_den, tp = 4.0 * p * (ww + sin2) / p_den;
    // d(p, q, x, y) and dT for one variable; dc enters explicitly, dsin2 = -2 c dc.
    const auto derivative = [&](double dc, double dp, double dq, double dx, double dy) {
      const double ds_den = 2.0 * ((c + p) * (dc + dp) + q * dq);
      const double dp_den = 2.0 * ((x + p) * (dx + dp) + (y + q) * (dy + dq));
      const double dww = 2.0 * (p * dp + q * dq) - 2.0 * c * dc;
      // Without a division by p, which is 0 where a dielectric (k = 0) reflects totally.
      const double dts = (4.0 * dp - ts * ds_den) / s_den;
      const double dtp = (4.0 * (dp * (ww + sin2) + p * dww) - tp * dp_den) / p_den;
      return -0.5 * (dc * (ts + tp) + c * (dts + dtp));
    };
    // dw = (n dn + c dc) / w.
    gradient->dc = derivative(1.0, c * p / ww, -c * q / ww, n2_re, n2_im);
    const double w_eta = (eta * p + k * q) / ww, w_k = (eta * q - k * p) / ww;
    gradient->deta = derivative(0.0, w_eta, -w_k, 2.0 * eta * c, 2.0 * k * c);
    gradient->dk = derivative(0.0, w_k, w_eta, -2.0 * k * c, 2.0 * eta * c);
  }
  return 0.5 * (rs + rp);
}

double FresnelDielectric(double c, double n, double* dF_dc, double* dF_dn) {
  const double gg = (n - 1.0) * (n + 1.0) + c * c;
  if (gg <= 0) {
    if (dF_dc != nullptr) *dF_dc = 0.0;
    if (dF_dn != nullptr) *dF_dn = 0.0;
    return 1.0;
  }
  const double g = std::sqrt(gg), n2 = n * n;
  // r_s = (c - g) / (c + g), r_p = (n^2 c - g) / (n^2 c + g); where g is near c, as for n near 1, the differences are
  // written out.
  const double contrast = (n - 1.0) * (n + 1.0), s_sum = c + g, p_sum = n2 * c + g;
  const bool near = n >= 1.0 && g < 2.0 * c;
  const double rs = near ? -contrast / (s_sum * s_sum) : (c - g) / s_sum;
  const double rp = near ? contrast * ((n2 + 1.0) * c * c - 1.0) / (p_sum * p_sum) : (n2 * c - g) / p_sum;
  // dr_s = 2 (g dc - c dg) / (c + g)^2, dr_p = 2 (g d(n^2 c) - n^2 c dg) / (n^2 c + g)^2, g dg = n dn + c dc.
  const double s_scale = 2.0 / (s_sum * s_sum * g), p_scale = 2.0 / (p_sum * p_sum * g);
  if (dF_dc != nullptr) *dF_dc = rs * s_scale * contrast + rp * p_scale * n2 * contrast;
  if (dF_dn != nullptr) *dF_dn = -rs * s_scale * c * n + rp * p_scale * n * c * (2.0 * gg - n2);
  return 0.5 * (rs * rs + rp * rp);
}

double DielectricTransmittance(double c, double n, double* dT_dc, double* dT_dn) {
  double dF_dc, dF_dn;
  FresnelDielectric(c, n, &dF_dc, &dF_dn);
  if (dT_dc != nullptr) *dT_dc = -dF_dc;
  if (dT_dn != nullptr) *dT_dn = -dF_dn;
  const double g = std::sqrt((n - 1.0) * (n + 1.0) + c * c), n2 = n * n;
  const double s_sum = c + g, p_sum = n2 * c + g;
  // 1 - r_s^2 = 4 c g / (c + g)^2, 1 - r_p^2 = 4 n^2 c g / (n^2 c + g)^2.
  return 2.0 * c * g * (1.0 / (s_sum * s_sum) + n2 / (p_sum * p_sum));
}

double DielectricMeanReflectance(double n, double* dF_dn) {
  const double d = (n - 1.0) * (n + 1.0);
  double sum = 0, slope = 0;
  if (d > 0) {
    // F falls within c < sqrt(d): panels 0, w, 2 w, 4 w .. 1.
    static const QuadratureRule rule = GaussLegendre(20);
    double from = 0;
    for (double to = 0.5 * std::sqrt(d); from < 1.0; from = to, to = 2.0 * to) {
      const double end = std::min(to, 1.0), half = 0.5 * (end - from), center = from + half;
      for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        const double c = center + half * rule.nodes[i], w = 2.0 * half * rule.weights[i] * c;
        double dF;
        sum += w * FresnelDielectric(c, n, nullptr, &dF);
        slope += w * dF;
      }
    }
  }
  if (dF_dn != nullptr) *dF_dn = slope;
  return sum;
}

}  // namespace lobefit
