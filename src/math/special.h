// Special functions that the models need and the standard library does not have (or only unscaled): each to a few units
// in the last place over its whole domain, as the tests measure.
#pragma once

#include <vector>

namespace lobefit {

// exp(x^2) erfc(x), any x; overflows below x = -26.6. Derivative: 2 x Erfcx(x) - 2 / sqrt(pi).
double Erfcx(double x);

// Langevin function coth(x) - 1/x and, if asked, its derivative 1/x^2 - 1/sinh^2(x); odd, any x.
double Langevin(double x, double* derivative = nullptr);

// Modified Bessel functions of the first kind, scaled: exp(-|x|) I_n(x) for n = 0, 1, 2, and exp(-|x|) (I_0(x) -
// I_1(|x|)) without cancellation; any finite x. Derivatives of the unscaled functions: I0' = I1, I1' = (I0 + I2) / 2.
struct ScaledBesselI {
  double i0, i1, i2, i0_minus_i1;
};
ScaledBesselI BesselIScaled(double x);

// Ratios rho_l = i_l(k) / i_{l-1}(k) of modified spherical Bessel functions of the first kind, l = 1 ... l_max, in
// rho[l] (rho[0] is unused and 0), by downward recurrence (upward where k is so large that this is as accurate); k > 0.
// `derivative`, if not null, receives d rho_l / dk in the same places. rho_1 is the Langevin function.
void SphericalBesselRatios(double k, int l_max, std::vector<double>* rho, std::vector<double>* derivative = nullptr);

// x - sin(x) and 1 - cos(x) without cancellation; any x.
double XMinusSin(double x);
double OneMinusCos(double x);

// atanh(x) - x without cancellation, |x| < 1.
double AtanhMinusX(double x);

// Gamma(x + 1/2) / Gamma(x) and, if asked, the derivative of its logarithm; x > 0. Without the logarithms of the two,
// whose difference would lose digits where they are large.
double GammaHalfRatio(double x, double* dlog = nullptr);

}  // namespace lobefit
