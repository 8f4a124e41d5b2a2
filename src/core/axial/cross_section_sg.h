// Cross-section of the spherical Gaussian of normals [dEon section 2.5], D = csch(k) k e^(k u) / (4 pi), k = 2 /
// alpha^2, sphere normalisation (int D dm = 1): exact, and every approximation of the paper in its corrected reading
// (MATH.md section 2), with measured errors and a choice among them. alpha > 0; it tends to Beckmann's roughness for
// small alpha and to the isotropic D = 1/(4 pi), sigma = 1/4, for large.
//
// Every u in [-1, 1]. Derivatives by alpha and u where not null; the value is the same bits either way. No clamps: the
// approximations may be slightly negative far behind (by at most their error).
#pragma once

#include "lobefit/math/vec.h"

namespace lobefit {

// Exact to about 1e-15 absolute. alpha >= 0.3: the sum over Legendre polynomials [dEon eq 38 with c_l = i_l(k) /
// i_0(k), MATH.md section 7]; below: the odd part in closed form and the rest by a fixed quadrature of eq 29 about its
// peak, with full relative accuracy for the tail u < 0.
double SgCrossSection(double alpha, double u, double* dsigma_dalpha = nullptr, double* dsigma_du = nullptr);

// The odd part, u L(k) / 2 with L the Langevin function [dEon eq 35], and the share sigma_2 of the band [dEon eq 37].
double SgCrossSectionOdd(double alpha, double u, double* dsigma_dalpha = nullptr, double* dsigma_du = nullptr);
double SgCrossSection2(double alpha, double u, double* dsigma_dalpha = nullptr, double* dsigma_du = nullptr);

// [dEon eq 40], the exponent's sign corrected: Beckmann's cross-section with the odd part made exact. Not
// differentiable at u = 0 (|u|); the derivative there is that of u > 0.
double SgCrossSectionEq40(double alpha, double u, double* dsigma_dalpha = nullptr, double* dsigma_du = nullptr);
// [dEon eq 41-43] corrected: T/4 u (1 + erf(A - B)) + sigma_2, exact to fourth order in u about the equator.
double SgCrossSectionEq41(double alpha, double u, double* dsigma_dalpha = nullptr, double* dsigma_du = nullptr);
// The sum over Legendre polynomials up to degree l_max >= 1 [dEon eq 38]; l_max = 2 is eq 44, l_max = 11 the paper's 12
// terms.
double SgCrossSectionHarmonics(double alpha, double u, int l_max, double* dsigma_dalpha = nullptr,
                               double* dsigma_du = nullptr);

// One way to compute the cross-section.
struct SgForm {
  enum Kind {
    kHarmonics,  // SgCrossSectionHarmonics(l_max)
    kBeckmann,   // BeckmannCrossSection [dEon eq 22]
    kEq40,
    kEq41,
    kExact,  // SgCrossSection
  };
  Kind kind = kExact;
  int l_max = 0;  // of kHarmonics
};

double SgCrossSection(const SgForm& form, double alpha, double u, double* dsigma_dalpha = nullptr,
                      double* dsigma_du = nullptr);

// Upper bound of the form's absolute error over all u at this alpha. For kBeckmann, kEq40 and kEq41 from measured
// maxima (12001 cosines at each of 33 alphas against the exact value, interpolated, plus 5 %); for kHarmonics from the
// sum of the terms left out. Infinite above alpha = 3 for the three forms made for small alpha.
double SgFormError(const SgForm& form, double alpha);

// The cheapest form whose error at this alpha is at most `max_error`, by the times measured for one value; kExact if
// none is.
SgForm CheapestSgForm(double alpha, double max_error);

}  // namespace lobefit
