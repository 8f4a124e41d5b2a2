// The BRDF of a surface whose microfacets are Lambertian.
#pragma once

#include "lobefit/core/microfacet/microfacet.h"

namespace lobefit {

// [Heitz 2014 eq 31] f_r / albedo = 1 / (pi (wo.n) (wi.n)) int <wo.m> <wi.m> G2(wo, wi, m) D(m) dm, 1/sr; first bounce
// only. No closed form exists: nested adaptive quadrature over the normals that face both directions, to the relative
// `tolerance` (measured on random ellipsoids with alphas from 0.01: 1e-9 at the default, a few milliseconds a call). 0
// if a direction is at or below the horizon. Linear in the facets' albedo. Gradient in the distribution's parameters;
// null skips it, the value then agrees within the tolerance.
double DiffuseMicrofacetBrdf(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                             const Vec3& wi, double* gradient = nullptr, double tolerance = 1e-10);

}  // namespace lobefit
