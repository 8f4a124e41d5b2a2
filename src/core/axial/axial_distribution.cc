#include "lobefit/core/axial/axial_distribution.h"

#include <algorithm>
#include <cmath>

namespace lobefit {

double AxialDistribution::D(const Vec3& wm, double* gradient) const {
  if (wm.z <= 0) {
    if (gradient != nullptr) *gradient = 0;
    return 0;
  }
  AxialGradient g;
  const double d = AxialD(ndf_, wm, gradient != nullptr ? &g : nullptr);
  if (gradient != nullptr) *gradient = g.dparameter;
  return d;
}

double AxialDistribution::Sigma(const Vec3& u, double* gradient) const {
  AxialGradient g;
  const double sigma = AxialSigma(ndf_, u.z, gradient != nullptr ? &g : nullptr);
  if (gradient != nullptr) *gradient = g.dparameter;
  return sigma;
}

Ellipsoid AxialDistribution::Outline() const {
  // 1 / (1 - b cos) falls to half its peak where theta^2 = 2 (1 - b) / b.
  const double width =
      ndf_.family == Family::kKagiwadaKalaba ? std::sqrt(2 * (1 - ndf_.parameter) / ndf_.parameter) : ndf_.parameter;
  const double alpha = std::min(width, 1.0);
  return {alpha, alpha, 0, 0, 0};
}

}  // namespace lobefit
