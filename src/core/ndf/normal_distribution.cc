#include "lobefit/core/ndf/normal_distribution.h"

#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/core/radial/smith.h"

namespace lobefit {

double NormalDistribution::Lambda(const Vec3& u, double* gradient) const {
  const double sigma = Sigma(u, gradient);
  if (gradient != nullptr) {
    for (int k = 0; k < parameters(); ++k) gradient[k] /= u.z;
  }
  return sigma / u.z - 1.0;
}

SlopeNormalDistribution::SlopeNormalDistribution(const SlopeDistribution& slopes)
    : slopes_(slopes), outline_(EllipsoidFromOffCenter(OffCenterFromSlopes(slopes))) {}

double SlopeNormalDistribution::D(const Vec3& wm, double* gradient) const {
  return SlopeDistributionD(slopes_, wm, gradient);
}

double SlopeNormalDistribution::Sigma(const Vec3& u, double* gradient) const {
  return SmithSigma(slopes_, u, gradient);
}

double SlopeNormalDistribution::Lambda(const Vec3& u, double* gradient) const {
  return CosineLambda(slopes_, u, gradient);
}

}  // namespace lobefit
