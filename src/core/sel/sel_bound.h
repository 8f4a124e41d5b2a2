// Upper bounds of a squared ellipsoidal lobe over sets of directions: how bright the lobe can make a light that lies
// somewhere in a cone or in a box. Conservative always, and as tight as asked for.
//
// Method. K = 1 / f^2, where f is the gauge of the ellipsoid: convex and homogeneous of degree 1. So f(v) >= grad f(v0)
// . v for every v and v0, and along an arc of a circle the right side has its minimum in closed form. The axis is K's
// only local maximum on the sphere (the critical points are the axis, a saddle opposite to it and, for alpha_min^2 < A
// (1+A)/2, two minima), hence the maximum over a set that does not hold the axis is on the set's rim. The rim, cut into
// arcs, is halved until the supporting planes meet the values; what is returned is the bound from the planes, never the
// value itself. Own derivation: [SEL] gives none.
#pragma once

#include "lobefit/math/vec.h"

namespace lobefit {

// `bound` >= K everywhere in the set and <= (1 + tolerance) max K, as far as rounding allows (which widens it by about
// 1e-15/alpha). `direction` is a unit world direction of the set at which K comes that near; the gradient of the
// maximum by the lobe's parameters is Sel's gradient there.
struct SelBound {
  double bound;
  Vec3 direction;
};

inline constexpr double kSelBoundTolerance = 1e-3;

// Over all directions within `half_angle` (radians, >= 0; pi and more is the whole sphere) of the unit vector `axis`,
// world space. A ball of radius r around a point at distance d > r is seen within the half angle asin(r / d).
SelBound SelBoundOverCone(double alpha_x, double alpha_y, const Vec3& rotation, const Vec3& axis, double half_angle,
                          double tolerance = kSelBoundTolerance);

// Over all directions from the origin to points of the box [lower, upper] (world axes; coordinates relative to the
// shading point). A box that holds the shading point gives 1.
SelBound SelBoundOverBox(double alpha_x, double alpha_y, const Vec3& rotation, const Vec3& lower, const Vec3& upper,
                         double tolerance = kSelBoundTolerance);

}  // namespace lobefit
