// Means of the ellipsoid BRDF over the discs of source and detector by quadrature to near rounding: what the fast forms
// (ggx_mean.h) are measured against, and what `lobefit eval aperture_ggx` gives.
#pragma once

#include "lobefit/core/instrument/aperture.h"
#include "lobefit/core/microfacet/ellipsoid_brdf.h"

namespace lobefit {

// A mean with its gradient by alpha_x, alpha_y, theta_x, theta_y, theta_z.
struct EllipsoidMean {
  double value = 0, gradient[kEllipsoidParameters] = {};
};

struct EllipsoidMeans {
  EllipsoidMean D;     // of D(wh), 1/sr
  EllipsoidMean fr;    // of f_r, clamped masking and a conductor's Fresnel factor, 1/sr
  EllipsoidMean flux;  // of f_r cos_i cos_o over the product of the mean cosines, 1/sr
};

// One disc: the integral is taken over its image in the frame in which the lobe is a cosine lobe (ggx_mean-inl.h), so
// that it costs the same for any width of either; the nodes are doubled until values agree to 1e-13. Where masking is
// clamped on part of the disc the sum is split along the clamp's end, at which derivatives jump. Both: that, averaged
// over the smaller disc, where a lobe much narrower than it ends at a limit of nodes, with errors as large as those of
// the fast form. The parts of the discs below the horizon do not count in `fr` and `flux`. A point: the values
// themselves.
EllipsoidMeans QuadratureMeans(const Ellipsoid& ellipsoid, const ConductorIndex& index, const Vec3& wo, const Vec3& wi,
                               const Aperture& aperture);

}  // namespace lobefit
