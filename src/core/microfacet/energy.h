// Energy of microfacet BRDFs: the weak white furnace, the directional albedo, what is missing after the first bounce,
// and the mean Fresnel reflectance of the visible normals.
//
// [Heitz] Heitz 2014 eq 31, 35-37, 102-105. All integrals run over the visible normals (visible_quadrature.h) instead
// of the reflected directions: di = 4 (wo.m) dm. `tolerance` is relative; at the default the reference table is met to
// 5e-15. A call takes milliseconds: these are for reports, tests and tables, not for the inner loop of a fit. wo above
// the horizon. Gradients are in the distribution's parameters; null skips them (the quadrature then refines for the
// value alone: same value within the tolerance, not bit for bit).
#pragma once

#include <functional>

#include "lobefit/core/microfacet/microfacet.h"

namespace lobefit {

inline constexpr double kEnergyTolerance = 1e-10;

// Reflectance at a cosine of incidence; for the derivative of an integral in a Fresnel parameter pass dF/d(parameter)
// instead: all are linear in F.
using FresnelOfCosine = std::function<double(double)>;

// Weak white furnace integral of specular microfacets [eq 36] over the whole sphere of wi: int G1(wo, m) <wo.m> D(m) dm
// / (wo.n). 1 for a masking function that a surface can have; min(1, sigma / cos) for clamped Smith masking (closed
// form); less or more for the comparison kinds. With diffuse microfacets [eq 37] it is the same integral.
double WeakFurnaceSphere(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                         double* gradient = nullptr, double tolerance = kEnergyTolerance);

// The same over the upper hemisphere only; below 1 also for exact masking, by what the first bounce sends down.
double WeakFurnaceHemisphere(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                             double* gradient = nullptr, double tolerance = kEnergyTolerance);

// [eq 37] over the upper hemisphere: a diffuse facet m sends (1 + m.n) / 2 of its light up.
double WeakFurnaceDiffuseHemisphere(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                                    double* gradient = nullptr, double tolerance = kEnergyTolerance);

// Directional albedo int f_r (wi.n) dwi of the BRDF with masking and shadowing (microfacet.h) and Fresnel reflectance
// F.
double DirectionalAlbedo(const NormalDistribution& distribution, const Shadowing& shadowing,
                         const FresnelOfCosine& fresnel, const Vec3& wo, double* gradient = nullptr,
                         double tolerance = kEnergyTolerance);

// E_2+(wo) = 1 - albedo for F = 1 [eq 104]: the energy of all paths of two and more bounces.
double EnergyMissing(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                     double* gradient = nullptr, double tolerance = kEnergyTolerance);

// [eq 105] int F(wo.m) D(m) <wo.m> dm / sigma(wo).
double MeanVisibleFresnel(const NormalDistribution& distribution, const FresnelOfCosine& fresnel, const Vec3& wo,
                          double* gradient = nullptr, double tolerance = kEnergyTolerance);

}  // namespace lobefit
