// The specular factor of any lobe that a model may have, and its Fresnel factor: the one place where the names of
// model.h meet the formulas.
#pragma once

#include <memory>

#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/core/brdf/microfacet.h"
#include "lobefit/core/brdf/model.h"
#include "lobefit/core/ndf/normal_distribution.h"
#include "lobefit/core/ndf/off_center.h"

namespace lobefit {

// specular[i] = D(wh) G2(wi, wo, wh) / (4 cos_theta_i cos_theta_o), 1/sr; cos_d[i] = wi . wh. gradient: as in
// ggx_lobe.h, by the slope coordinates. GGX with separable or height-correlated masking is evaluated in SIMD (some 80
// million samples a second and core), every other lobe one sample at a time (one to three million).
// Round distributions on the sphere read the width a only. [Heitz eq 29], microfacet.h.
void SpecularLobe(const DirectionArrays& directions, const Lobe& lobe, const SlopeCoordinates& shape, double* specular,
                  double* cos_d, double* gradient);

// One sample; the same bits.
double SpecularLobe(const Vec3& wi, const Vec3& wo, const Lobe& lobe, const SlopeCoordinates& shape, double* cos_d,
                    double gradient[5]);

// The normal distribution of a lobe. `jacobian`: d(distribution's parameters) / d(slope coordinates), row-major,
// parameters() rows of 5; null skips it.
std::unique_ptr<NormalDistribution> DistributionOf(Ndf ndf, const SlopeCoordinates& shape, double* jacobian);

// The masking by the name that microfacet.h has for it; kSchlickSmith reads its m from the shape.
Shadowing ShadowingOf(Masking masking, const SlopeCoordinates& shape);

// F at cos_d with the parameters of `fresnel` in the order of Parameters(model); dF: FresnelParameters(fresnel)
// entries, null skips them. kNone: the scale itself.
double FresnelFactor(Fresnel fresnel, const double* parameters, double cos_d, double* dF);

}  // namespace lobefit
