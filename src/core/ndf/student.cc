#include "lobefit/core/ndf/student.h"

#include <algorithm>
#include <cmath>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

// x / (1 + x) - log1p(x).
double Bracket(double x) {
  if (x >= 0.1) return x / (1.0 + x) - std::log1p(x);
  // -x^2/2 + 2 x^3/3 - 3 x^4/4 + ...
  double sum = 0, power = -x;
  for (int n = 2; n < 24; ++n) {
    power *= -x;
    sum -= power * (n - 1.0) / n;
  }
  return sum;
}

}  // namespace

SlopeDistribution PowerLawSlopes(double gamma, const SlopeDistribution& slopes) {
  if (!(gamma > 1.5 && std::isfinite(gamma))) {
    throw InputError("Student's distribution with gamma = " + FormatDouble(gamma) +
                     " has no mean slope; gamma must be above 1.5");
  }
  SlopeDistribution scaled = slopes;
  scaled.alpha_x *= std::sqrt(gamma - 1.0);
  scaled.alpha_y *= std::sqrt(gamma - 1.0);
  return scaled;
}

double StudentD(double gamma, const SlopeDistribution& slopes, const Vec3& wm, double* gradient) {
  if (!(wm.z > 0)) {
    if (gradient != nullptr) std::fill_n(gradient, kSlopeParameters + 1, 0.0);
    return 0.0;
  }
  const SlopeQuadratic q = EvaluateSlopeQuadratic(slopes, wm.x + slopes.slope_x * wm.z, wm.y + slopes.slope_y * wm.z);
  const double zz = wm.z * wm.z, rest = gamma - 1.0, x = std::min(q.value / zz, 1e300) / rest;
  // The square as GGX has it, the rest of the exponent apart: the same bits at gamma = 2.
  const double h = zz + q.value / rest;
  const double value = SlopeNormalisation(slopes) / (h * h) * std::exp((2.0 - gamma) * std::log1p(x));
  if (gradient != nullptr) {
    FillSlopeGradient(slopes, q, value, -gamma / rest * value / h, wm.z, gradient);
    // d ln f / dgamma = gamma / (gamma - 1) x / (1 + x) - log1p(x).
    gradient[kSlopeParameters] = value * (x / (1.0 + x) / rest + Bracket(x));
  }
  return value;
}

StudentDistribution::StudentDistribution(const std::shared_ptr<const ProfileMasking>& power_law,
                                         const SlopeDistribution& slopes)
    : gamma_(2.0 + power_law->profile().q()[0]),
      slopes_(slopes),
      power_law_(power_law, PowerLawSlopes(gamma_, slopes)) {}

double StudentDistribution::Sigma(const Vec3& u, double* gradient) const {
  const double value = power_law_.Sigma(u, gradient);
  if (gradient != nullptr) {
    const double scale = std::sqrt(gamma_ - 1.0);
    gradient[0] *= scale;
    gradient[1] *= scale;
    gradient[kSlopeParameters] +=
        0.5 * (slopes_.alpha_x * gradient[0] + slopes_.alpha_y * gradient[1]) / (gamma_ - 1.0);
  }
  return value;
}

}  // namespace lobefit
