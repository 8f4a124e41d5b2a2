// Fresnel reflectance of smooth surfaces in air or vacuum, unpolarised light, with gradients.
//
// c = cosine of the angle of incidence (to the micro normal), domain [0, 1]. A null pointer skips a derivative; the
// value is the same bits either way.
#pragma once

#include <cmath>

namespace lobefit {

// [Schlick 1994] F = f0 + (1 - f0) (1 - c)^5. Linear in f0: dF_df0 = 1 - (1 - c)^5.
double FresnelSchlick(double c, double f0, double* dF_dc = nullptr, double* dF_df0 = nullptr);

// Complex refractive index eta + i k, relative to the outside.
struct ConductorIndex {
  double eta = 1.0, k = 0.0;
};

struct ConductorFresnelGradient {
  double dc, deta, dk;
};

// Exact reflectance of a conductor, eta > 0, k > 0 (k = 0: FresnelDielectric, which knows total reflection). With
// p + i q = sqrt((eta + i k)^2 - sin^2), 1 - F = (T_s + T_p) / 2, T_s = 4 c p / |c + w|^2, T_p = 4 c p (|w|^2 + sin^2)
// / |n^2 c + w|^2: every factor is a sum of positive terms, so value and derivatives keep their digits towards grazing
// and towards F = 1.
double FresnelConductor(double c, const ConductorIndex& index, ConductorFresnelGradient* gradient = nullptr);

// Exact reflectance of a dielectric of relative index n > 0. For n < 1 total reflection is a kink of the physics:
// beyond the critical angle F = 1 and both derivatives are 0.
double FresnelDielectric(double c, double n, double* dF_dc = nullptr, double* dF_dn = nullptr);

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
