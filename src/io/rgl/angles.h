// Parametrisation of directions on the unit square in RGL files [Dupuy and Jakob 2018]: last axis theta-like,
// second-last phi-like.
#pragma once

#include <cmath>

#include "lobefit/math/vec.h"

namespace lobefit {

// theta = x^2 pi/2 and back; phi = (2 y - 1) pi and back.
inline double RglTheta(double x) { return x * x * kPi / 2; }
inline double RglX(double theta) { return std::sqrt(2 * theta / kPi); }
inline double RglPhi(double y) { return (2 * y - 1) * kPi; }
inline double RglY(double phi) { return (phi + kPi) / (2 * kPi); }

// d(theta) d(phi) sin(theta) = 2 pi^2 x sin(theta) dx dy: solid angle of the micro normal per area of the unit square.
inline double RglNormalJacobian(double x, double theta) { return 2 * kPi * kPi * x * std::sin(theta); }

}  // namespace lobefit
