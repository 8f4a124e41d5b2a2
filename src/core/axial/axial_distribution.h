// The axial distributions of axial_ndf.h as normal distributions: Kagiwada-Kalaba and the spherical Gaussian in every
// reflectance and energy integral that takes a NormalDistribution.
#pragma once

#include "lobefit/core/axial/axial_ndf.h"
#include "lobefit/core/ndf/normal_distribution.h"

namespace lobefit {

// One parameter, that of the AxialNdf. D is 0 below the horizon, where no half vector lies, but sigma counts the
// normals there: the integral of G1 D <m.u> over the upper normals is below u.n by their share (axial_ndf.h).
class AxialDistribution final : public NormalDistribution {
 public:
  explicit AxialDistribution(const AxialNdf& ndf) : ndf_(ndf) {}
  using NormalDistribution::D;
  using NormalDistribution::Sigma;
  int parameters() const override { return 1; }
  double D(const Vec3& wm, double* gradient) const override;
  double Sigma(const Vec3& u, double* gradient) const override;
  // A centred round lobe of about the same width.
  Ellipsoid Outline() const override;

 private:
  AxialNdf ndf_;
};

}  // namespace lobefit
