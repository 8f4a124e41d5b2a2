// The ABg lobe of polished and finely ground surfaces, which scatter by a power of the distance from the mirror
// direction in direction cosines: f_r = A / (B + |beta - beta_0|^g), with beta - beta_0 = (wi + wo)_xy. It is what
// stray-light programs take, and its shape does not change with the incidence [Harvey; MATH.md section 8.7].
//
// As ABg is written in them; changed from print: the width is named as that of other lobes, in slopes of the half
// vector, whose part along the surface is |beta - beta_0| / 2 at small angles, and the height as a reflectance, so that
// at the mirror direction f_r is that of a GGX lobe of the same numbers:
//   f_r = scale / (4 pi alpha_x alpha_y (1 + t^(g/2))),   t = |L^-1 (wi + wo)_xy / 2|^2,
// L the Cholesky factor ((a, 0), (b, c)) of the ellipse. Round: B = (2 alpha)^g, A = B scale / (4 pi alpha^2). There is
// no masking, and energy is kept by no rule: for g < 2 most of it lies far from the peak.
#pragma once

#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/core/ndf/normal_distribution.h"

namespace lobefit {

inline constexpr std::size_t kAbgParameters = 6;  // the ellipse's slope coordinates, g

// specular[i] = f_r of scale 1, 1/sr, and cos_d[i] = wi . wh; gradient: kAbgParameters arrays of `count`, by the slope
// coordinates (that of the mean slope is 0: the lobe lies about the mirror direction) and by g; null skips it.
void AbgLobe(const DirectionArrays& directions, const SlopeCoordinates& shape, double g, double* specular,
             double* cos_d, double* gradient);

// Integral of f_r cos_theta_o over the hemisphere at scale 1, the total integrated scatter of wi: over the unit disc of
// beta, by a product rule (relative error below 1e-5 to 80 degrees of incidence, which is tested).
double AbgAlbedo(const SlopeCoordinates& shape, double g, const Vec3& wi);

// What the lobe shows of normals: D with D / 4 the lobe where the half vector is wm and wi near it. Not normalised:
// there is no surface behind it. Parameters as the gradient of AbgLobe.
class AbgDistribution final : public NormalDistribution {
 public:
  AbgDistribution(const SlopeCoordinates& shape, double g) : shape_(shape), g_(g) {}
  using NormalDistribution::D;
  using NormalDistribution::Sigma;
  int parameters() const override { return kAbgParameters; }
  double D(const Vec3& wm, double* gradient) const override;
  // Of a plane.
  double Sigma(const Vec3& u, double* gradient) const override;
  Ellipsoid Outline() const override;

 private:
  SlopeCoordinates shape_;
  double g_;
};

}  // namespace lobefit
