// Integral of a squared ellipsoidal lobe against the clamped cosine about a normal: the lobe's contribution to
// irradiance.
#pragma once

#include "lobefit/core/sel/sel.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {

// int over the sphere of K(w) max(0, normal . w) dw for a lobe with rotation vector `rotation`; `normal` a unit world
// direction. gradient->ddirection is the derivative by the components of the normal (the vector irradiance; its product
// with the normal is the value), gradient->drotation by the rotation vector. The clamp makes no kink in the integral.
//
// No closed form is known for unequal alphas: nested adaptive quadrature over half great circles from the axis to its
// opposite. On each, tan(theta/2) = rho tan(tau/2) with rho the lobe's width in that azimuth makes the integrand smooth
// however narrow the lobe is, the azimuth is stretched likewise, and the clamp cuts each half circle exactly once, at a
// known angle. A relative error of options.relative is asked of value and gradient alike; about 3e4 evaluations at
// 1e-9. Not in [SEL].
double SelCosineIntegral(double alpha_x, double alpha_y, const Vec3& rotation, const Vec3& normal,
                         SelGradient* gradient = nullptr, SelKink kink = SelKink::kNone,
                         const QuadratureOptions& options = {1e-9, 0, 2000});

}  // namespace lobefit
