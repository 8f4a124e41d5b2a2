// Masking-shadowing of two directions from their Smith Lambdas, the V-cavity model, and three functions for comparison
// only.
//
// [Heitz] Heitz 2014: eq 98 separable, 99 height-correlated, 100 direction-correlated (MATH.md section 4: the first
// term is lambda G1(wo) G1(wi)), 101 height- and direction-correlated, 49-50 V-cavity, 56-60 implicit and Kelemen. For
// Lambda >= 0: (98) <= (99) <= (101) <= min(G1(wo), G1(wi)). The factor X+(wo.m) X+(wi.m) is the caller's where not
// said otherwise.
#pragma once

#include "lobefit/core/masking/masking.h"
#include "lobefit/math/vec.h"

namespace lobefit {

struct SmithG2Gradient {
  double dLambda_o, dLambda_i, dlambda;
};

// G2 of two Lambdas >= 0 (the separable kinds: > -1) under a Smith masking (IsSmith); lambda in [0, 1] is read by the
// direction-correlated kinds only. kDirection and kHeightDirection have a kink at Lambda_o = Lambda_i; there the larger
// one is taken to be Lambda_o.
double SmithG2(Masking masking, double Lambda_o, double Lambda_i, double lambda, SmithG2Gradient* gradient = nullptr);

// Angle in [0, pi] between the azimuths of two directions; 0 if one of them is along the normal.
double AzimuthDifference(const Vec3& wo, const Vec3& wi);

// [Heitz, after eq 101; van Ginneken 1998] 4.41 phi / (4.41 phi + 1), phi in [0, pi] radians: 0 for equal azimuths, at
// most .933.
double VanGinnekenLambda(double phi, double* dlambda_dphi = nullptr);

// V-cavity masking min(1, 2 (m.n) (w.n) / (w.m)) X+(w.m) [Heitz eq 49]. It belongs to distributions with D(x, y, z) =
// D(-x, -y, z) only: for a lobe that leans it does not conserve projected area. Derivatives in the components as free
// variables; a kink at value 1, where they are 0.
double VCavityG1(const Vec3& w, const Vec3& m, Vec3* dG1_dw = nullptr, Vec3* dG1_dm = nullptr);

// Spherical angles of wo, wi and the micro normal; radians.
struct VCavityAngles {
  double theta_o, phi_o, theta_i, phi_i, theta_m, phi_m;
};
// G1 of wo and wi and G2 = min of both [Heitz eq 50], with gradients in the six angles in their order (null skips).
// Evaluated in extended precision where the machine has it, because w.m of grazing directions cancels.
struct VCavityValues {
  double G1_o, G1_i, G2;
};
VCavityValues VCavity(const VCavityAngles& angles, double* dG1_o = nullptr, double* dG2 = nullptr);

// For comparison only: these do not come from a surface and fail the weak white furnace test. Each is given as G1 of
// one direction; G2 = G1(wo) G1(wi). Implicit [Heitz eq 56]: w.n, so that the cosines of the BRDF cancel.
double ImplicitG1(const Vec3& w, Vec3* dG1_dw = nullptr);
// Schlick-Smith [Schlick 1994 eq 19]: c / (c (1 - k) + k), k = sqrt(2 / pi) m. Renderers put m = alpha; RMS slope m =
// alpha / sqrt(2) is the other reading of the paper [Heitz sec 4.3].
double SchlickSmithG1(const Vec3& w, double m, double* dG1_dm = nullptr, Vec3* dG1_dw = nullptr);
// Kelemen [Heitz eq 59]: (w.n) / (w.h); exceeds 1 and can create energy.
double KelemenG1(const Vec3& w, const Vec3& wh, Vec3* dG1_dw = nullptr, Vec3* dG1_dwh = nullptr);

}  // namespace lobefit
