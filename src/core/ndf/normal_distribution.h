// One face for every normal distribution, so that masking, BRDF and energy integrals are written once.
#pragma once

#include "lobefit/core/ellipsoid/ellipsoid.h"
#include "lobefit/core/radial/slope_distribution.h"
#include "lobefit/math/vec.h"

namespace lobefit {

inline constexpr int kMaxDistributionParameters = 24;  // of a profile with 20 knots

// A distribution of micro normals over one macro area: int D(m) (m.n) dm = 1, sigma(u) = int D(m) <m.u> dm. Immutable:
// safe to share between threads. Gradients have parameters() entries; null skips them, the value is the same bits
// either way.
class NormalDistribution {
 public:
  virtual ~NormalDistribution() = default;
  virtual int parameters() const = 0;
  // 1/sr, for unit wm; 0 below the horizon.
  virtual double D(const Vec3& wm, double* gradient) const = 0;
  // For any unit u.
  virtual double Sigma(const Vec3& u, double* gradient) const = 0;
  // sigma(u) / u.z - 1 for u.z > 0; overridden where it can be had without the subtraction.
  virtual double Lambda(const Vec3& u, double* gradient) const;
  // An ellipsoid whose lobe lies where this one is concentrated: quadratures take their breaks from it. It need not
  // fit.
  virtual Ellipsoid Outline() const = 0;

  double D(const Vec3& wm) const { return D(wm, nullptr); }
  double Sigma(const Vec3& u) const { return Sigma(u, nullptr); }
};

// [Walter eq 1]; parameters alpha_x, alpha_y, theta_x, theta_y, theta_z.
class EllipsoidDistribution final : public NormalDistribution {
 public:
  explicit EllipsoidDistribution(const Ellipsoid& ellipsoid) : ellipsoid_(ellipsoid), frame_(ellipsoid) {}
  using NormalDistribution::D;
  using NormalDistribution::Sigma;
  int parameters() const override { return kEllipsoidParameters; }
  double D(const Vec3& wm, double* gradient) const override { return frame_.D(wm, gradient); }
  double Sigma(const Vec3& u, double* gradient) const override { return frame_.Sigma(u, gradient); }
  double Lambda(const Vec3& u, double* gradient) const override { return frame_.Lambda(u, gradient); }
  Ellipsoid Outline() const override { return ellipsoid_; }

 private:
  Ellipsoid ellipsoid_;
  EllipsoidFrame frame_;
};

// Beckmann and GGX in slope space [Heitz eq 64-97]; parameters alpha_x, alpha_y, r, slope_x, slope_y.
class SlopeNormalDistribution final : public NormalDistribution {
 public:
  explicit SlopeNormalDistribution(const SlopeDistribution& slopes);
  using NormalDistribution::D;
  using NormalDistribution::Sigma;
  int parameters() const override { return kSlopeParameters; }
  double D(const Vec3& wm, double* gradient) const override;
  double Sigma(const Vec3& u, double* gradient) const override;
  double Lambda(const Vec3& u, double* gradient) const override;
  Ellipsoid Outline() const override { return outline_; }

 private:
  SlopeDistribution slopes_;
  Ellipsoid outline_;
};

}  // namespace lobefit
