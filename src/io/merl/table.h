// The layout of MERL tables: shared by reader and writer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lobefit/io/text/format.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// f_r = stored value x scale, for R, G, B.
inline constexpr std::array<double, 3> kMerlScale = {1.00 / 1500, 1.15 / 1500, 1.66 / 1500};

// Index along the axis of theta_h (a whole number is a cell's lower edge): denser towards the peak.
inline double MerlThetaH(double index) { return index / 90 * (index / 90) * kPi / 2; }

// Numbers of cells as they stand in the head of a file; those of the database are 90 x 90 x 180.
struct MerlDims {
  std::int32_t theta_h, theta_d, phi_d;

  constexpr std::uint64_t cells() const {
    return static_cast<std::uint64_t>(theta_h) * static_cast<std::uint64_t>(theta_d) *
           static_cast<std::uint64_t>(phi_d);
  }
};

// Size of a file with positive dims.
constexpr std::uint64_t MerlBytes(const MerlDims& dims) { return 12 + 3 * 8 * dims.cells(); }

// ReadMerl behind its checks: a table of positive `dims` in exactly MerlBytes(dims) bytes, phi_d over the whole turn or
// half of it. Small tables are for fuzzing.
Measurement ReadMerlTable(std::string_view bytes, const MerlDims& dims, bool whole_turn, CellPosition position);

}  // namespace lobefit
