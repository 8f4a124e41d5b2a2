// The microfacet BRDF of the ellipsoid distribution with separable Smith masking (kSmithSeparable or kSmithUnclamped,
// MATH.md section 5), and Lambert's.
//
// [Walter] ellipsoid NDF, eq 4-6:  f_r = F(c) D(wh) G1(wo) G1(wi) / (4 (wo.n) (wi.n)),  c = wo.wh,  in 1/sr.
// Directions are unit vectors away from the surface, n = +z; at or below the horizon f_r is 0. All functions are
// reciprocal, bit for bit. Gradients are in the order alpha_x, alpha_y, theta_x, theta_y, theta_z, then the Fresnel
// parameters; null skips them.
#pragma once

#include "lobefit/core/ellipsoid/ellipsoid.h"
#include "lobefit/core/fresnel/fresnel.h"
#include "lobefit/core/masking/masking.h"
#include "lobefit/math/vec.h"

namespace lobefit {

struct BrdfFactors {
  double D, G1_o, G1_i, F;
  bool clamped_o, clamped_i;  // G1 would exceed 1 (also told where it is not clamped)
};

// d f_r in the components of the directions, taken as free vectors; only the part perpendicular to each has a meaning.
struct BrdfDirectionGradient {
  Vec3 wo, wi;
};

// Conductor: gradient[7] ends with eta, k.
double EllipsoidConductorBrdf(const Ellipsoid& ellipsoid, const ConductorIndex& index, const Vec3& wo, const Vec3& wi,
                              Masking masking, double* gradient = nullptr, BrdfFactors* factors = nullptr,
                              BrdfDirectionGradient* direction_gradient = nullptr);

// Schlick's Fresnel: gradient[6] ends with f0; f_r is linear in (1, f0).
double EllipsoidSchlickBrdf(const Ellipsoid& ellipsoid, double f0, const Vec3& wo, const Vec3& wi, Masking masking,
                            double* gradient = nullptr, BrdfFactors* factors = nullptr,
                            BrdfDirectionGradient* direction_gradient = nullptr);

// albedo / pi above the horizon of both directions, else 0.
double LambertBrdf(double albedo, const Vec3& wo, const Vec3& wi, double* df_dalbedo = nullptr);

// Definition by the printed formulas for any scalar; p = the five, eta, k; G1 clamped or not by `clamp`.
template <class T>
T EllipsoidConductorBrdfFormula(const T* p, const Vec3T<T>& wo, const Vec3T<T>& wi, bool clamp) {
  const Vec3T<T> wh = Normalized(wo + wi);
  T g_o = wo.z / EllipsoidSigmaFormula(p, wo), g_i = wi.z / EllipsoidSigmaFormula(p, wi);
  if (clamp && g_o > 1.0) g_o = T(1.0);
  if (clamp && g_i > 1.0) g_i = T(1.0);
  const T f = FresnelConductorFormula(Dot(wo, wh), p[5], p[6]);
  return f * EllipsoidDFormula(p, wh) * g_o * g_i / (T(4.0) * wo.z * wi.z);
}

}  // namespace lobefit
