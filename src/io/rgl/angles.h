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

// Directions nearer to the horizon than this (0.06 degrees) have no f_r: it is the table's value over a cosine that the
// table's float32 angles do not determine (many files end with theta_i = float(pi / 2)).
inline constexpr double kRglHorizon = 1e-3;

// d(theta) d(phi) sin(theta) = 2 pi^2 x sin(theta) dx dy: solid angle of the micro normal per area of the unit square.
inline double RglNormalJacobian(double x, double theta) { return 2 * kPi * kPi * x * std::sin(theta); }

}  // namespace lobefit
