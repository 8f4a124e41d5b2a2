// Normal distributions that depend on the polar angle only, as ingredients of a microfacet reflectance: D, the
// cross-section sigma and the masking G1 = cos / sigma, each with gradient. All are normalised by the projected area of
// their front-facing part,
//   int D(m) max(0, m.n) dm = 1,   hence sigma(n) = 1,
// so that any of them can stand where GGX's D stands: f_r = D G F / (4 cos_i cos_o).
//
// Kagiwada-Kalaba and the spherical Gaussian [dEon eq 26, 28] live on the whole sphere of normals. Their unit-integral
// form D1 (1/sr) is divided by N = int D1 (m.n)+ dm = sigma1(1), which AxialNormalisation gives:
//   Kagiwada-Kalaba, b in (0, 1):        1/N = 2 b atanh(b) / (-b - ln(1 - b))
//   spherical Gaussian, k = 2 / alpha^2: 1/N = k (1 - e^-2k) / (k - 1 + e^-k)
// Normals that face down count in sigma, hence in G1, but no half vector of two upper directions reaches them: their
// share of the energy is missing from the reflectance (it is the "porous" part of the medium), and the weak furnace
// over half vectors is 1 less that share. For Beckmann and GGX there is none and N = 1.
//
// sigma is convex in the direction, so sigma(u) >= u sigma(1) = u: G1 <= 1 without a clamp.
#pragma once

#include "lobefit/core/radial/family.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// Of any family but kProfile and kStudent. The parameter is alpha > 0, or b in (0, 1) for Kagiwada-Kalaba (b -> 0
// isotropic, b -> 1 a flat surface).
struct AxialNdf {
  Family family = Family::kGgx;
  double parameter = 1;
};

// Derivatives by the parameter and by the cosine with n (the gradient by a direction w is dcos times n).
struct AxialGradient {
  double dparameter, dcos;
};

// 1 / int D1 (m.n)+ dm, the factor by which the unit-integral form is multiplied, and its derivative. 1 for Beckmann
// and GGX.
double AxialNormalisation(const AxialNdf& ndf, double* dparameter = nullptr);

// D(wm), 1/sr; wm a unit direction anywhere on the sphere. 0 for wm.z <= 0 in Beckmann and GGX. 1 - wm.z is taken from
// x and y, so that narrow lobes keep their digits.
double AxialD(const AxialNdf& ndf, const Vec3& wm, AxialGradient* gradient = nullptr);

// sigma(u) = int D(m) (m.w)+ dm, u = w.n in [-1, 1]; sigma(1) = 1.
double AxialSigma(const AxialNdf& ndf, double u, AxialGradient* gradient = nullptr);

// G1 = u / sigma(u), u in (0, 1]: in (0, 1].
double AxialG1(const AxialNdf& ndf, double u, AxialGradient* gradient = nullptr);

}  // namespace lobefit
