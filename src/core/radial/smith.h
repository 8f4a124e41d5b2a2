// Smith masking of slope distributions: signed Lambda, projected area sigma, masking G1.
//
// [Heitz] Heitz 2014, eq 69, 72, 83, 86, 96-97; [Loubet] eq 1. Changed from print: Lambda for a < 0 (the printed GGX
// form drops the sign of a), forms without cancellation for large |a|.
//   c(u) = u_z - slope_x u_x - slope_y u_y   projected area of the mean (meso) surface, any sign
//   q(u) = alpha_o^2 sin^2 theta             squared width of the distribution along u, a = c / sqrt(q)
//   sigma(u) = int D(m) <m.u> dm = c (1 + Lambda(a)) >= 0 for either sign of c; at q = 0 (u along the normal) sigma =
//   max(c, 0).
// Two conventions of G1 exist; do not mix them (MATH.md section 4): SmithG1 = c / sigma = 1 / (1 + Lambda) belongs with
// a BRDF that divides by c (LEADR), |u.n| / sigma [Walter, Loubet] with one that divides by the cosines. The BRDFs of
// this library use the second. u is a unit direction; gradients are in the order alpha_x, alpha_y, r, slope_x, slope_y;
// null skips them.
#pragma once

#include "lobefit/core/radial/slope_distribution.h"

namespace lobefit {

struct ProjectedSlopes {
  double c, q, a;
};

// c, q and a with gradients dc, dq (5 each). c is summed with error terms: exact to rounding also where its terms
// cancel.
ProjectedSlopes ProjectSlopes(const SlopeDistribution& s, const Vec3& u, double* dc = nullptr, double* dq = nullptr);

// Lambda(a) of [Heitz eq 69, 72] for any a != 0, its derivative; +inf gives 0.
double SmithLambdaOfA(Family family, double a, double* dLambda_da = nullptr);

double SmithLambda(const SlopeDistribution& distribution, const Vec3& u, double* gradient = nullptr);
double SmithSigma(const SlopeDistribution& distribution, const Vec3& u, double* gradient = nullptr,
                  Vec3* dsigma_du = nullptr);

// sigma / u_z - 1 for u_z > 0: Lambda in the convention of BRDFs that divide by the cosines; equal to SmithLambda for a
// zero mean slope, negative where the masking is clamped. No cancellation near the normal.
double CosineLambda(const SlopeDistribution& distribution, const Vec3& u, double* gradient = nullptr);

// c / sigma = 1 / (1 + Lambda); domain c > 0.
double SmithG1(const SlopeDistribution& distribution, const Vec3& u, double* gradient = nullptr);

// min(1, u_z / sigma) [Loubet eq 1]; where the quotient exceeds 1 (a kink) the gradient is 0 and `clamped` is set.
double SmithG1Clamped(const SlopeDistribution& distribution, const Vec3& u, double* gradient = nullptr,
                      bool* clamped = nullptr);

// Definition of Lambda as printed, with the sign of a, for any scalar that has erf; the oracle of the tests for
// moderate |a|.
template <class T>
T SmithLambdaFormula(Family family, const T& a) {
  using std::erf;
  using std::exp;
  using std::sqrt;
  if (family == Family::kBeckmann) return (erf(a) - T(1.0)) * T(0.5) + exp(-a * a) / (T(2.0 * std::sqrt(kPi)) * a);
  const T root = sqrt(T(1.0) + T(1.0) / (a * a));
  return (a < 0.0 ? -root - T(1.0) : root - T(1.0)) * T(0.5);
}

}  // namespace lobefit
