// Interpolation in the table of a profile's masking (profile_masking.h) for arrays of a, in SIMD.
#pragma once

#include <cstddef>
#include <vector>

namespace lobefit {

// Nodes evenly spaced in asinh(a) from one break to the next.
struct ProfileBreak {
  double from, per_step;  // asinh(a); steps a unit of it
  std::size_t first, steps;
};

struct ProfileTable {
  const std::vector<ProfileBreak>* breaks;
  const double* nodes;
  const double* rows;  // [node][M, T, P2][stride], a multiple of 4
  std::size_t stride;
};

// difference[i * stride + k] = M(a[i]) of column k by quintic Hermite interpolation, a[i] >= 0 below the last node;
// slope[i] = dM / da of column 0. Without `slope` column 0 alone is set.
void InterpolateProfile(const ProfileTable& table, const double* a, std::size_t count, double* slope,
                        double* difference);

}  // namespace lobefit
