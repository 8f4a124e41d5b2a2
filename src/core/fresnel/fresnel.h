// Fresnel reflectance of smooth surfaces in air or vacuum, unpolarised light, with gradients.
//
// c = cosine of the angle of incidence (to the micro normal), domain [0, 1]. A null pointer skips a derivative; the
// value is the same bits either way.
#pragma once

#include <cmath>
#include <cstddef>

namespace lobefit {

// [Schlick 1994] F = f0 + (1 - f0) (1 - c)^5. Linear in f0: dF_df0 = 1 - (1 - c)^5.
double FresnelSchlick(double c, double f0, double* dF_dc = nullptr, double* dF_df0 = nullptr);

// Schlick with an edge tint [Hoffman 2019; Kutz 2021], as OpenPBR and MaterialX (color82) have it: F = S(c) - b c (1 -
// c)^6, S Schlick's, b such that F = tint S at c = 1/7 (82 degrees). tint = 1 is Schlick. Linear in f0 and b; F can be
// negative where f0 and tint are both small (MATH.md 8.3).
struct SchlickF82Gradient {
  double dc, df0, dtint;
};
double FresnelSchlickF82(double c, double f0, double tint, SchlickF82Gradient* gradient = nullptr);
// b; dF/db = -c (1 - c)^6.
double SchlickF82Coefficient(double f0, double tint);

// F(c) = sum_k F_k b_k(c), cubic B-splines over the knots 0 0 0 0 .25 .6 1 1 1 1: six non-negative functions whose sum
// is 1. F_0 is F at grazing, F_5 at normal incidence; coefficients in [0, 1] keep F there. basis: b_k = dF/dF_k;
// slope: db_k/dc; null skips it. c = 1 belongs to the last interval.
inline constexpr std::size_t kFresnelCurveSize = 6;
void FresnelCurveBasis(double c, double* basis, double* slope = nullptr);
// Coefficients of the curve nearest to Schlick's F, to .0017 for f0 >= .04, .006 at f0 = 0; none is negative.
void FresnelCurveOfSchlick(double f0, double* coefficients);

// Complex refractive index eta + i k, relative to the outside.
struct ConductorIndex {
  double eta = 1.0, k = 0.0;
};

struct ConductorFresnelGradient {
  double dc, deta, dk;
};

// Exact reflectance of a conductor, eta > 0, k >= 0 (k = 0 is a dielectric; at its critical angle derivatives are
// infinite). With p + i q = sqrt((eta + i k)^2 - sin^2), 1 - F = (T_s + T_p) / 2, T_s = 4 c p / |c + w|^2, T_p = 4 c p
// (|w|^2 + sin^2) / |n^2 c + w|^2: every factor is a sum of positive terms, so value and derivatives keep their digits
// towards grazing and towards F = 1.
double FresnelConductor(double c, const ConductorIndex& index, ConductorFresnelGradient* gradient = nullptr);

// Exact reflectance of a dielectric of relative index n > 0. For n < 1 total reflection is a kink of the physics:
// beyond the critical angle F = 1 and both derivatives are 0.
double FresnelDielectric(double c, double n, double* dF_dc = nullptr, double* dF_dn = nullptr);

// 1 - F of a dielectric, n >= 1, as a sum of positive terms: keeps its digits towards grazing.
double DielectricTransmittance(double c, double n, double* dT_dc = nullptr, double* dT_dn = nullptr);

// Mean reflectance of a dielectric, n >= 1, for light that comes from all directions: outside, F_ex = 2 int_0^1 F(c) c
// dc, and inside, 1 - (1 - F_ex) / n^2. [Elias 2001; closed form in MATH.md 8.4] By quadrature of a form without
// subtraction, since the closed one has no digits left near n = 1.
double DielectricMeanReflectance(double n, double* dF_dn = nullptr);

// Definition of the conductor by amplitudes r_s = (c - w) / (c + w), r_p = (n^2 c - w) / (n^2 c + w), for any scalar.
template <class T>
T FresnelConductorFormula(const T& c, const T& eta, const T& k) {
  using std::sqrt;
  const T n2_re = eta * eta - k * k, n2_im = T(2.0) * eta * k;
  const T re = n2_re - T(1.0) + c * c;
  const T modulus = sqrt(re * re + n2_im * n2_im);
  T p, q;
  if (re >= 0.0) {
    p = sqrt((modulus + re) * T(0.5));
    q = n2_im / (T(2.0) * p);
  } else {
    q = sqrt((modulus - re) * T(0.5));
    p = n2_im / (T(2.0) * q);
  }
  const T rs = ((c - p) * (c - p) + q * q) / ((c + p) * (c + p) + q * q);
  const T x = n2_re * c, y = n2_im * c;
  const T rp = ((x - p) * (x - p) + (y - q) * (y - q)) / ((x + p) * (x + p) + (y + q) * (y + q));
  return T(0.5) * (rs + rp);
}

}  // namespace lobefit
