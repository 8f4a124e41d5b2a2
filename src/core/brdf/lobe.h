// The specular factor of any lobe that a model may have, and its Fresnel factor: the one place where the names of
// model.h meet the formulas.
#pragma once

#include <memory>
#include <vector>

#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/core/brdf/model.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/core/microfacet/microfacet.h"
#include "lobefit/core/ndf/normal_distribution.h"
#include "lobefit/core/radial/profile_masking.h"

namespace lobefit {

// The shape of a lobe: its ellipse in slope space and, for profiles and Student's, what goes with their coefficients.
// To make one of a profile takes a millisecond; it serves all samples.
struct LobeShape {
  LobeShape() = default;
  LobeShape(const SlopeCoordinates& ellipse) : slope(ellipse) {}  // NOLINT: every other family is its ellipse
  // `profile`: the shape parameters after the five of the ellipse. Throws InputError where they leave the domain.
  LobeShape(const Lobe& lobe, const SlopeCoordinates& ellipse, const std::vector<double>& profile);

  SlopeCoordinates slope;
  double exponent = 2;                            // gamma of Student's, g of ABg
  std::shared_ptr<const ProfileMasking> masking;  // of a profile; of the power law for Student's
};
// From values in the order of Parameters(model), inside units, beginning with the lobe's alpha_x.
LobeShape ShapeAt(const Lobe& lobe, const std::vector<double>* values);

// specular[i] = D(wh) G2(wi, wo, wh) / (4 cos_theta_i cos_theta_o), 1/sr; cos_d[i] = wi . wh. gradient: as in
// ggx_lobe.h, ShapeParameters(lobe) arrays: by the slope coordinates, then by gamma or q. GGX with separable or
// height-correlated masking is evaluated in SIMD (some 80 million samples a second and core), profiles and Student's
// with these by their tables (some 10), every other lobe by its general form (one to three).
// Round distributions on the sphere read the width a only. A retro lobe is evaluated at the mirrored wi, an ABg lobe is
// its f_r (abg_lobe.h). [Heitz eq 29], microfacet.h.
void SpecularLobe(const DirectionArrays& directions, const Lobe& lobe, const LobeShape& shape, double* specular,
                  double* cos_d, double* gradient);

// One sample; the same bits.
double SpecularLobe(const Vec3& wi, const Vec3& wo, const Lobe& lobe, const LobeShape& shape, double* cos_d,
                    double* gradient);

// The normal distribution of a lobe. `jacobian`: d(distribution's parameters) / d(slope coordinates, then the
// profile's), row-major, parameters() rows of ShapeParameters(lobe); null skips it.
std::unique_ptr<NormalDistribution> DistributionOf(const Lobe& lobe, const LobeShape& shape,
                                                   std::vector<double>* jacobian);

// The masking by the name that microfacet.h has for it; kSchlickSmith reads its m from the shape.
Shadowing ShadowingOf(Masking masking, const SlopeCoordinates& shape);

// F at cos_d with the parameters of `fresnel` in the order of Parameters(model); dF: FresnelParameters(fresnel)
// entries, and dF_dcos_d; null skips them. kNone: the scale itself. Of a coat that of its surface.
double FresnelFactor(Fresnel fresnel, const double* parameters, double cos_d, double* dF, double* dF_dcos_d = nullptr);

}  // namespace lobefit
