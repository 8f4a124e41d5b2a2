// Means of GGX lobes over what is no whole disc: rectangular detectors, and discs or rectangles that the horizon cuts.
// The image of such a region in the slope plane is a polygon, over which the slope distribution has a closed form
// [Loubet section 3].
#pragma once

#include <array>
#include <vector>

#include "lobefit/core/brdf/model.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/core/instrument/ggx_mean.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// Directions about one, as a polygon of great circles: each corner the multiples of the direction w itself, of the
// horizontal towards which the polar angle grows, and of the horizontal across it that it is made of; counter-clockwise
// as seen from the sample's outside.
struct DirectionRegion {
  std::vector<std::array<double, 3>> corners;
  double cosine = 0;  // integral of w'.w over it
};
// A disc, as a polygon of 64 corners of the same area.
DirectionRegion DiscRegion(double half_angle);
// A flat rectangle that faces the sample, with half angles along the meridian and across it; at w = z, along x and y.
DirectionRegion RectangleRegion(double along, double across);

// Share of a constant f_r that a region about w sees, of flux over the cosine of w: 1 above the horizon, and a little
// more where the horizon cuts it, as what is below has a negative cosine.
double ConstantMean(const Vec3& w, const DirectionRegion& region);

// Flux mean of D G2 / (4 cos_i cos_o) over the region about wo, light at the point wi: the integral of the slope
// distribution over the region's image times a D-weighted mean of the rest over points of it, denser where the lobe is
// high. What is below the horizon reflects nothing. By reciprocity the mean over a region about the light is that with
// wi and wo exchanged. With w the region's half width over the lobe's, half_angle / (2 alpha cos_d): error below 1e-3
// of the value for w up to 10 on whole regions, 3e-3 for w up to 5 on cut ones, and a tenth at 20, where both
// directions graze. argument and gradients as GgxMeanLobe; gradients null together. The points follow the lobe, which
// gradients leave out: they are off by the error of the value over alpha. wi.z, wo.z > 0.
double GgxRegionMean(const Vec3& wi, const Vec3& wo, const SlopeCoordinates& shape, Masking masking,
                     const DirectionRegion& region, FresnelArgument kind, double* argument, double gradient[5],
                     double argument_gradient[5]);

}  // namespace lobefit
