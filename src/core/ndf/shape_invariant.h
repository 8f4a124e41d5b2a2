// Shape-invariant distributions of normals: a radial profile (profile.h) stretched, sheared and moved in slope space.
//
// [Heitz] Heitz 2014 sec 5.3, eq 73-78, 87-97; MATH.md section 8.1. With H = m_z^2 + Q (Q of [Heitz eq 95] times
// m_z^2), D is GGX's D times e^E pi / Z, and sigma is GGX's sigma plus sqrt(q) times what M differs: at q = 0 both are
// those of slope_distribution.h and smith.h to the bit.
#pragma once

#include <memory>

#include "lobefit/core/ndf/normal_distribution.h"
#include "lobefit/core/radial/profile_masking.h"

namespace lobefit {

// Parameters alpha_x, alpha_y, r, slope_x, slope_y as in slope_distribution.h (`slopes.family` is not read), then the
// profile's coefficients.
class ShapeInvariantDistribution final : public NormalDistribution {
 public:
  ShapeInvariantDistribution(std::shared_ptr<const ProfileMasking> masking, const SlopeDistribution& slopes);
  using NormalDistribution::D;
  using NormalDistribution::Sigma;
  int parameters() const override;
  double D(const Vec3& wm, double* gradient) const override;
  // From the table: absolute error 1e-12 sqrt(q). Behind the mean facet (a < 0), where sigma is smaller than that, no
  // digit of it need be right.
  double Sigma(const Vec3& u, double* gradient) const override;
  Ellipsoid Outline() const override { return outline_; }

 private:
  std::shared_ptr<const ProfileMasking> masking_;
  SlopeDistribution slopes_;
  Ellipsoid outline_;
};

}  // namespace lobefit
