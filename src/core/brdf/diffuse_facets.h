// Lambertian microfacets inside a fit: the integral of diffuse_microfacets.h by one fixed rule, so that its value is a
// smooth function of the lobe and a call costs microseconds.
#pragma once

#include <memory>
#include <vector>

#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/core/brdf/model.h"
#include "lobefit/core/microfacet/microfacet.h"

namespace lobefit {

// [Heitz 2014 eq 31] f_r / albedo = G2(wo, wi) K / (pi cos_theta_o cos_theta_i),
//   K = int <wo.m> <wi.m> D dm = int P22(s) <wo.s> <wi.s> / sqrt(1 + |s|^2) ds,   <u.s> = max(0, u_z - s . u_xy).
// The rule: 24 radii by 48 angles in the unit disc of slopes, Gauss-Legendre in atan r for GGX and in r up to 6 for
// Beckmann. Its error is that of the two edges <.> = 0: relative, against the adaptive integral, at most 2e-3 for
// directions within 80 degrees (test). For GGX and Beckmann lobes with a Smith masking.
class DiffuseFacets {
 public:
  DiffuseFacets(const Lobe& lobe, const SlopeCoordinates& shape);

  // f_r / albedo, 1/sr; gradient by the slope coordinates, null skips it. wi, wo above the horizon.
  double Evaluate(const Vec3& wi, const Vec3& wo, double gradient[5]) const;
  // Arrays as in ggx_lobe.h.
  void Evaluate(const DirectionArrays& directions, double* value, double* gradient) const;

 private:
  std::vector<double> jacobian_;  // before what its making fills it
  std::unique_ptr<NormalDistribution> distribution_;
  Shadowing shadowing_;
  // Nodes: slopes, places in the unit disc, and weight / sqrt(1 + |s|^2).
  std::vector<double> s_x_, s_y_, unit_x_, unit_y_, weight_;
  double a_, c_;
};

}  // namespace lobefit
