#include "lobefit/core/axial/axial_ndf.h"

#include <cmath>

#include "lobefit/core/axial/cross_section.h"
#include "lobefit/core/axial/cross_section_sg.h"

namespace lobefit {
namespace {

// (k - 1 + e^-k) / k^2 and its derivative, without cancellation for small k.
double ShadowFunction(double k, double* derivative) {
  if (k < 1) {
    double power = 1, sum = 0, slope = 0;  // sum over j of (-k)^j / (j + 2)!
    double factorial = 2;
    for (int j = 0; j < 20; ++j) {
      sum += power / factorial;
      slope -= (j + 1) * power / (factorial * (j + 3));
      power *= -k;
      factorial *= j + 3;
    }
    *derivative = slope;
    return sum;
  }
  const double value = (k + std::expm1(-k)) / (k * k);
  *derivative = -std::expm1(-k) / (k * k) - 2 * value / k;
  return value;
}

// sigma of the unit-integral form (projected-area form for Beckmann and GGX, which have N = 1).
double UnitSigma(const AxialNdf& ndf, double u, double* dparameter, double* du) {
  switch (ndf.family) {
    case Family::kBeckmann:
      return BeckmannCrossSection(ndf.parameter, u, dparameter, du);
    case Family::kGgx:
      return GgxCrossSection(ndf.parameter, u, dparameter, du);
    case Family::kKagiwadaKalaba:
      return KagiwadaKalabaCrossSection(ndf.parameter, u, dparameter, du);
    default:  // kSphericalGaussian
      break;
  }
  return SgCrossSection(ndf.parameter, u, dparameter, du);
}

}  // namespace

double AxialNormalisation(const AxialNdf& ndf, double* dparameter) {
  double norm = 1, slope = 0;  // N and dN / dparameter
  if (ndf.family == Family::kKagiwadaKalaba) {
    norm = KagiwadaKalabaCrossSection(ndf.parameter, 1, dparameter != nullptr ? &slope : nullptr);
  } else if (ndf.family == Family::kSphericalGaussian) {
    // N = k f(k) / (1 - e^-2k), f = (k - 1 + e^-k) / k^2
    const double alpha = ndf.parameter, k = 2 / (alpha * alpha);
    double f_slope = 0;
    const double f = ShadowFunction(k, &f_slope);
    const double den = -std::expm1(-2 * k);
    norm = k * f / den;
    // d log(k / (1 - e^-2k)) = 1/k - 2 / (e^2k - 1)
    slope = norm * (1 / k - 2 / std::expm1(2 * k) + f_slope / f) * (-2 * k / alpha);
  }
  if (dparameter != nullptr) *dparameter = -slope / (norm * norm);
  return 1 / norm;
}

double AxialD(const AxialNdf& ndf, const Vec3& wm, AxialGradient* gradient) {
  const double c = wm.z;
  const double sin2 = wm.x * wm.x + wm.y * wm.y;
  const double below = c > 0 ? sin2 / (1 + c) : 1 - c;  // 1 - c
  double d = 0, dparameter = 0, dcos = 0;
  const double p = ndf.parameter;
  switch (ndf.family) {
    case Family::kBeckmann: {
      if (c <= 0) break;
      const double c2 = c * c, tan = std::sqrt(sin2) / (c * p), t = tan * tan;
      if (t > 800) break;  // zero in double precision, where t or 1/c^4 may overflow
      d = std::exp(-t) / (kPi * p * p * c2 * c2);
      dparameter = d * 2 * (t - 1) / p;
      // tan^2 = 1/c^2 - 1
      dcos = d * (2 / (p * p * c2) - 4) / c;
      break;
    }
    case Family::kGgx: {
      if (c <= 0) break;
      const double den = p * p * c * c + sin2;
      d = p * p / (kPi * den * den);
      dparameter = d * (2 / p - 4 * p * c * c / den);
      dcos = d * 4 * c * (1 - p) * (1 + p) / den;
      break;
    }
    case Family::kKagiwadaKalaba: {
      double slope = 0;
      const double factor = AxialNormalisation(ndf, gradient != nullptr ? &slope : nullptr);
      const double one = (1 - p) + p * below, l = std::atanh(p);  // 1 - b c
      d = factor * p / (4 * kPi * one * l);
      dparameter = d * (slope / factor + 1 / p + c / one - 1 / ((1 - p) * (1 + p) * l));
      dcos = d * p / one;
      break;
    }
    case Family::kSphericalGaussian: {
      double slope = 0;
      const double factor = AxialNormalisation(ndf, gradient != nullptr ? &slope : nullptr);
      const double k = 2 / (p * p);
      d = -factor * k * std::exp(-k * below) / (2 * kPi * std::expm1(-2 * k));
      dparameter = d * (slope / factor + (1 / k - below - 2 / std::expm1(2 * k)) * (-2 * k / p));
      dcos = d * k;
      break;
    }
    default:
      break;
  }
  if (gradient != nullptr) *gradient = {dparameter, dcos};
  return d;
}

double AxialSigma(const AxialNdf& ndf, double u, AxialGradient* gradient) {
  if (gradient == nullptr) return UnitSigma(ndf, u, nullptr, nullptr) * AxialNormalisation(ndf);
  double dparameter = 0, du = 0, slope = 0;
  const double sigma = UnitSigma(ndf, u, &dparameter, &du), factor = AxialNormalisation(ndf, &slope);
  *gradient = {dparameter * factor + sigma * slope, du * factor};
  return sigma * factor;
}

double AxialG1(const AxialNdf& ndf, double u, AxialGradient* gradient) {
  const double sigma = AxialSigma(ndf, u, gradient);
  const double g1 = u / sigma;
  if (gradient != nullptr) *gradient = {-g1 * gradient->dparameter / sigma, (1 - g1 * gradient->dcos) / sigma};
  return g1;
}

}  // namespace lobefit
