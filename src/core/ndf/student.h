// Student's t distribution of slopes: one exponent between GGX (gamma = 2) and Beckmann (gamma -> infinity).
//
// [Ribardiere 2017] Ribardiere, Bringier, Meneveaux and Simonot, STD: Student's t-distribution of slopes for
// microfacet based BSDFs; MATH.md section 8.2. f = (1 + t / (gamma - 1))^-gamma, Z = pi; the mean slope exists for
// gamma > 3/2. With alpha times sqrt(gamma - 1) it is the power law of profile.h, from which its masking is taken: M
// has a closed form (hypergeometric), its derivative by gamma has none.
#pragma once

#include <memory>

#include "lobefit/core/ndf/shape_invariant.h"
#include "lobefit/core/radial/slope_distribution.h"

namespace lobefit {

// The slopes of the power law whose density is Student's: alphas times sqrt(gamma - 1). InputError unless gamma > 3/2.
SlopeDistribution PowerLawSlopes(double gamma, const SlopeDistribution& slopes);

// D(wm), 1/sr; 0 for wm.z <= 0. Gradient by alpha_x, alpha_y, r, slope_x, slope_y, gamma. `slopes.family` is not read.
double StudentD(double gamma, const SlopeDistribution& slopes, const Vec3& wm, double* gradient = nullptr);

// Parameters as those of StudentD. `power_law`: of ProfileSpline::PowerLaw(), q_1 = gamma - 2.
class StudentDistribution final : public NormalDistribution {
 public:
  StudentDistribution(const std::shared_ptr<const ProfileMasking>& power_law, const SlopeDistribution& slopes);
  using NormalDistribution::D;
  using NormalDistribution::Sigma;
  int parameters() const override { return kSlopeParameters + 1; }
  double D(const Vec3& wm, double* gradient) const override { return StudentD(gamma_, slopes_, wm, gradient); }
  double Sigma(const Vec3& u, double* gradient) const override;
  Ellipsoid Outline() const override { return power_law_.Outline(); }

 private:
  double gamma_;
  SlopeDistribution slopes_;
  ShapeInvariantDistribution power_law_;
};

}  // namespace lobefit
