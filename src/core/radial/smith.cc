#include "lobefit/core/radial/smith.h"

#include <algorithm>

#include "lobefit/math/special.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

// x - p1 q1 - p2 q2, as if computed in twice the precision and rounded once.
double MinusProducts(double x, double p1, double q1, double p2, double q2) {
  const double a = p1 * q1, a_error = std::fma(p1, q1, -a);
  const double b = p2 * q2, b_error = std::fma(p2, q2, -b);
  const auto subtract = [](double u, double v, double* error) {
    const double s = u - v, t = s - u;
    *error = (u - (s - t)) - (v + t);
    return s;
  };
  double e1, e2;
  const double s = subtract(subtract(x, a, &e1), b, &e2);
  return s + (e1 + e2 - a_error - b_error);
}

// sigma(c, q) and its partial derivatives.
struct Sigma {
  double value, dc, dq;
};

Sigma SigmaOf(Family family, const ProjectedSlopes& p) {
  const double c = p.c, q = p.q;
  if (family == Family::kGgx) {
    const double s = std::sqrt(c * c + q);
    const double sum = c >= 0 ? c + s : q / (s - c);
    return {0.5 * sum, 0.5 * sum / s, 0.25 / s};
  }
  if (!(q > 0)) return {std::max(c, 0.0), c > 0 ? 1.0 : 0.0, 0.0};  // u along the normal: e^(-a^2) = 0
  const double root = std::sqrt(q), gauss = std::exp(-p.a * p.a);
  const double dq = 0.25 * kInvSqrtPi * gauss / root;
  if (c >= 0) return {0.5 * (c * (1.0 + std::erf(p.a)) + root * kInvSqrtPi * gauss), 0.5 * (1.0 + std::erf(p.a)), dq};
  return {0.5 * root * gauss * (kInvSqrtPi + p.a * Erfcx(-p.a)), 0.5 * std::erfc(-p.a), dq};
}

void Combine(double df_dc, double df_dq, const double* dc, const double* dq, double* gradient) {
  for (int k = 0; k < kSlopeParameters; ++k) gradient[k] = df_dc * dc[k] + df_dq * dq[k];
}

}  // namespace

// q = ((A + B)^2 (1 + r) + (A - B)^2 (1 - r)) / 2 with A = alpha_x u_x, B = alpha_y u_y.
ProjectedSlopes ProjectSlopes(const SlopeDistribution& s, const Vec3& u, double* dc, double* dq) {
  const double A = s.alpha_x * u.x, B = s.alpha_y * u.y;
  const double sum = (A + B) * (1.0 + s.r), difference = (A - B) * (1.0 - s.r);
  const double c = MinusProducts(u.z, s.slope_x, u.x, s.slope_y, u.y);
  const double q = 0.5 * ((A + B) * sum + (A - B) * difference);
  if (dc != nullptr) {
    dc[0] = dc[1] = dc[2] = 0.0;
    dc[3] = -u.x;
    dc[4] = -u.y;
  }
  if (dq != nullptr) {
    dq[0] = (sum + difference) * u.x;
    dq[1] = (sum - difference) * u.y;
    dq[2] = 2.0 * A * B;
    dq[3] = dq[4] = 0.0;
  }
  return {c, q, c / std::sqrt(q)};
}

double SmithLambdaOfA(Family family, double a, double* dLambda_da) {
  if (family == Family::kGgx) {
    const double root = std::sqrt(1.0 + a * a);
    if (dLambda_da != nullptr) *dLambda_da = -0.5 / (a * a * root);
    return a > 0 ? 0.5 / (a * (a + root)) : 0.5 * (root / a - 1.0);
  }
  const double gauss = std::exp(-a * a);
  if (dLambda_da != nullptr) *dLambda_da = -0.5 * kInvSqrtPi * gauss / (a * a);
  // erf(a) - 1 has no digits left for a > 5; both terms carry e^(-a^2).
  if (a > 0) return 0.5 * gauss * (kInvSqrtPi / a - Erfcx(a));
  return 0.5 * (std::erf(a) - 1.0 + kInvSqrtPi * gauss / a);
}

double SmithLambda(const SlopeDistribution& distribution, const Vec3& u, double* gradient) {
  double dc[kSlopeParameters], dq[kSlopeParameters];
  const bool derivatives = gradient != nullptr;
  const ProjectedSlopes p = ProjectSlopes(distribution, u, derivatives ? dc : nullptr, derivatives ? dq : nullptr);
  // In c and q, not in a: finite at q = 0.
  double value, dvalue_dc, dvalue_dq;
  if (distribution.family == Family::kGgx) {
    const double s = std::sqrt(p.c * p.c + p.q);
    value = p.c > 0 ? 0.5 * p.q / (p.c * (p.c + s)) : 0.5 * (s / p.c - 1.0);
    dvalue_dc = -0.5 * p.q / (s * p.c * p.c);
    dvalue_dq = 0.25 / (p.c * s);
  } else {
    double dLambda_da = 0.0;
    value = SmithLambdaOfA(distribution.family, p.a, &dLambda_da);
    dvalue_dc = p.q > 0 ? dLambda_da / std::sqrt(p.q) : 0.0;
    dvalue_dq = p.q > 0 ? -0.5 * dLambda_da * p.a / p.q : 0.0;
  }
  if (derivatives) Combine(dvalue_dc, dvalue_dq, dc, dq, gradient);
  return value;
}

double SmithSigma(const SlopeDistribution& distribution, const Vec3& u, double* gradient, Vec3* dsigma_du) {
  double dc[kSlopeParameters], dq[kSlopeParameters];
  const bool derivatives = gradient != nullptr;
  const ProjectedSlopes p = ProjectSlopes(distribution, u, derivatives ? dc : nullptr, derivatives ? dq : nullptr);
  const Sigma sigma = SigmaOf(distribution.family, p);
  if (derivatives) Combine(sigma.dc, sigma.dq, dc, dq, gradient);
  if (dsigma_du != nullptr) {
    const double A = distribution.alpha_x * u.x, B = distribution.alpha_y * u.y;
    const double sum = (A + B) * (1.0 + distribution.r), difference = (A - B) * (1.0 - distribution.r);
    *dsigma_du = {sigma.dq * (sum + difference) * distribution.alpha_x - sigma.dc * distribution.slope_x,
                  sigma.dq * (sum - difference) * distribution.alpha_y - sigma.dc * distribution.slope_y, sigma.dc};
  }
  return sigma.value;
}

double CosineLambda(const SlopeDistribution& distribution, const Vec3& u, double* gradient) {
  const double sigma = SmithSigma(distribution, u, gradient);
  if (gradient != nullptr) {
    for (int k = 0; k < kSlopeParameters; ++k) gradient[k] /= u.z;
  }
  const ProjectedSlopes p = ProjectSlopes(distribution, u);
  if (!(p.c > 0)) return sigma / u.z - 1.0;
  // sigma - c, then c - u_z.
  const double rough = distribution.family == Family::kGgx ? 0.5 * p.q / (p.c + std::sqrt(p.c * p.c + p.q))
                                                           : p.c * SmithLambdaOfA(distribution.family, p.a);
  return (rough - (distribution.slope_x * u.x + distribution.slope_y * u.y)) / u.z;
}

double SmithG1(const SlopeDistribution& distribution, const Vec3& u, double* gradient) {
  const double value = 1.0 / (1.0 + SmithLambda(distribution, u, gradient));
  if (gradient != nullptr) {
    for (int k = 0; k < kSlopeParameters; ++k) gradient[k] *= -value * value;
  }
  return value;
}

double SmithG1Clamped(const SlopeDistribution& distribution, const Vec3& u, double* gradient, bool* clamped) {
  const double sigma = SmithSigma(distribution, u, gradient);
  const double value = std::abs(u.z) / sigma;
  // u.z > sigma = c (1 + Lambda) without the rounding of sigma, which would be wrong where Lambda is tiny.
  const double c = ProjectSlopes(distribution, u).c;
  const double behind = distribution.slope_x * u.x + distribution.slope_y * u.y;  // u.z - c
  const bool is_clamped = c > 0 && u.z > 0 ? behind > c * SmithLambda(distribution, u) : value > 1.0;
  if (clamped != nullptr) *clamped = is_clamped;
  if (gradient != nullptr) {
    for (int k = 0; k < kSlopeParameters; ++k) gradient[k] *= is_clamped ? 0.0 : -value / sigma;
  }
  return is_clamped ? 1.0 : std::min(1.0, value);
}

}  // namespace lobefit
