// The layout of MERL tables: shared by reader and writer.
#pragma once

#include <array>
#include <cstddef>

#include "lobefit/math/vec.h"

namespace lobefit {

// f_r = stored value x scale, for R, G, B.
inline constexpr std::array<double, 3> kMerlScale = {1.00 / 1500, 1.15 / 1500, 1.66 / 1500};

// Index along the axis of theta_h (a whole number is a cell's lower edge): denser towards the peak.
inline double MerlThetaH(double index) { return index / 90 * (index / 90) * kPi / 2; }

// Size of a file with 90 x 90 x `phi_d` cells.
inline constexpr std::size_t MerlBytes(std::size_t phi_d) { return 12 + 3 * 8 * 90 * 90 * phi_d; }

}  // namespace lobefit
