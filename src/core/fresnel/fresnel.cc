#include "lobefit/core/fresnel/fresnel.h"

namespace lobefit {

double FresnelSchlick(double c, double f0, double* dF_dc, double* dF_df0) {
  const double m = 1.0 - c, m2 = m * m, m4 = m2 * m2, m5 = m4 * m;
  if (dF_dc != nullptr) *dF_dc = -5.0 * (1.0 - f0) * m4;
  if (dF_df0 != nullptr) *dF_df0 = 1.0 - m5;
  return f0 + (1.0 - f0) * m5;
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
    q = 0.5 * n2_im / p;
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
      const double dts = ts * (dp / p - ds_den / s_den);
      const double dtp = tp * (dp / p + dww / (ww + sin2) - dp_den / p_den);
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
  const double rs = (c - g) / (c + g), rp = (n2 * c - g) / (n2 * c + g);
  // dr_s = 2 (g dc - c dg) / (c + g)^2, dr_p = 2 (g d(n^2 c) - n^2 c dg) / (n^2 c + g)^2, g dg = n dn + c dc.
  const double s_scale = 2.0 / ((c + g) * (c + g) * g), p_scale = 2.0 / ((n2 * c + g) * (n2 * c + g) * g);
  const double contrast = (n - 1.0) * (n + 1.0);
  if (dF_dc != nullptr) *dF_dc = rs * s_scale * contrast + rp * p_scale * n2 * contrast;
  if (dF_dn != nullptr) *dF_dn = -rs * s_scale * c * n + rp * p_scale * n * c * (2.0 * gg - n2);
  return 0.5 * (rs * rs + rp * rp);
}

}  // namespace lobefit
