// What the inner loop reads of a block's samples. Internal to the kernel.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "lobefit/fit/kernel/kernel.h"
#include "lobefit/fit/kernel/kernel_arrays.h"

namespace lobefit {

// An input array of a block: in place where the block is full, else a copy with `pad` behind it.
inline const double* PaddedArray(const double* from, std::size_t count, std::size_t padded, double pad,
                                 std::vector<double>* copy) {
  if (padded == count) return from;
  copy->assign(from, from + count);
  copy->resize(padded, pad);
  return copy->data();
}

inline bool HasWeights(const KernelSamples& samples) {
  return samples.weight != nullptr || samples.solid_angle != nullptr || samples.sin_i || samples.sin_o;
}

// Square roots of the weights of samples [begin, begin + count), 0 for pads. `cos_o`: read where the sine of theta_o
// weighs.
inline void WriteWeightRoots(const KernelSamples& samples, std::size_t begin, std::size_t count, std::size_t padded,
                             const double* cos_i, const double* cos_o, std::span<double> to) {
  std::fill_n(to.data(), count, 1.0);
  std::fill(to.begin() + static_cast<std::ptrdiff_t>(count), to.end(), 0.0);
  for (const double* factor : {samples.weight, samples.solid_angle}) {
    for (std::size_t i = 0; factor != nullptr && i < count; ++i) to[i] *= factor[begin + i];
  }
  if (samples.sin_i) arrays::TimesSine(cos_i, padded, to.data());
  if (samples.sin_o) arrays::TimesSine(cos_o, padded, to.data());
  if (HasWeights(samples)) arrays::FinishWeight(samples.weight_scale, padded, to.data());
}

}  // namespace lobefit
