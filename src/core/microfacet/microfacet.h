// The specular microfacet BRDF of any normal distribution with any masking-shadowing function.
//
// [Heitz] Heitz 2014 eq 29: f_r = F(c) D(wh) G2(wo, wi, wh) / (4 (wo.n) (wi.n)), c = wo.wh. The Smith kinds are built
// from Lambda(u) = sigma(u) / (u.n) - 1, i.e. G1 = (u.n) / sigma(u) [Walter eq 6, Loubet eq 1]: for a centred
// distribution this is Heitz' Lambda, for one that leans it is the convention of a BRDF that divides by the cosines
// (MATH.md section 4). Lambda can then be negative, down to -1; it is cut at 0, a kink, which for the separable kind
// gives exactly [Walter eq 5-6]. The separable kind alone exists without the cut (kSmithUnclamped): in the
// correlated ones the denominator could vanish.
#pragma once

#include "lobefit/core/masking/g2.h"
#include "lobefit/core/masking/masking.h"
#include "lobefit/core/ndf/normal_distribution.h"

namespace lobefit {

struct Shadowing {
  Masking masking = Masking::kSmithSeparable;
  double schlick_m = 0.0;  // read by kSchlickSmith only; constant, no derivative is taken
};

// Lambda(w) of the Smith kinds; `cut` says whether it was negative and is given as 0, with a zero gradient.
double MaskingLambda(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& w,
                     double* gradient = nullptr, bool* cut = nullptr);

// G1(w) of the kind with micro normal wm: what a BRDF with masking but no shadowing uses. Gradient in the
// distribution's parameters.
double MaskingG1(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& w, const Vec3& wm,
                 double* gradient = nullptr);

// G2(wo, wi, wm), 0 where wo.wm <= 0 or wi.wm <= 0. wo and wi above the horizon.
double MaskingShadowingG2(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                          const Vec3& wi, const Vec3& wm, double* gradient = nullptr);

// f_r / F: the factor of the Fresnel reflectance, 1/sr. 0 if wo or wi is at or below the horizon. `cos_d` receives
// wo.wh, the cosine for F.
double MicrofacetSpecular(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                          const Vec3& wi, double* gradient = nullptr, double* cos_d = nullptr);

}  // namespace lobefit
