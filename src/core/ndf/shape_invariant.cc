#include "lobefit/core/ndf/shape_invariant.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/core/radial/smith.h"

namespace lobefit {

ShapeInvariantDistribution::ShapeInvariantDistribution(std::shared_ptr<const ProfileMasking> masking,
                                                       const SlopeDistribution& slopes)
    : masking_(std::move(masking)), slopes_(slopes), outline_(EllipsoidFromOffCenter(OffCenterFromSlopes(slopes))) {
  slopes_.family = Family::kGgx;
}

int ShapeInvariantDistribution::parameters() const {
  return kSlopeParameters + static_cast<int>(masking_->profile().q().size());
}

double ShapeInvariantDistribution::D(const Vec3& wm, double* gradient) const {
  return ProfileD(masking_->profile(), slopes_, wm, gradient);
}

// sigma = sqrt(q) S(a), a = c / sqrt(q): dsigma = S' dc + (S - a S') dq / (2 sqrt(q)); here for S less GGX's.
double ShapeInvariantDistribution::Sigma(const Vec3& u, double* gradient) const {
  const double ggx = SmithSigma(slopes_, u, gradient);
  double dc[kSlopeParameters], dq[kSlopeParameters];
  const ProjectedSlopes p = ProjectSlopes(slopes_, u, dc, dq);
  const std::size_t K = masking_->profile().q().size();
  if (!(p.q > 0)) {
    if (gradient != nullptr) std::fill_n(gradient + kSlopeParameters, K, 0.0);
    return ggx;
  }
  const double root = std::sqrt(p.q), a = std::abs(p.a);
  std::vector<double> difference(masking_->stride());
  double slope;
  masking_->Differences(&a, 1, &slope, difference.data());
  if (gradient != nullptr) {
    const double in_c = p.a > 0 ? slope : -slope, in_q = 0.5 * (difference[0] - a * slope) / root;
    for (int k = 0; k < kSlopeParameters; ++k) gradient[k] += in_c * dc[k] + in_q * dq[k];
    for (std::size_t k = 0; k < K; ++k) gradient[kSlopeParameters + k] = root * difference[1 + k];
  }
  return ggx + root * difference[0];
}

}  // namespace lobefit
