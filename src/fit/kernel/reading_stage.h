// What the instrument makes of f_r in a block of samples: the reading is g f_r, and its product with cos_theta_i is too
// high by an offset. Internal to the kernel.
#pragma once

#include <cstddef>
#include <numeric>
#include <span>

#include "lobefit/fit/kernel/block_arrays.h"
#include "lobefit/fit/kernel/kernel.h"

namespace lobefit {

class ReadingStage {
 public:
  // `slopes`: the derivatives by the gains, which need none of the model's; `gradient` includes them.
  ReadingStage(const KernelSamples& samples, const KernelModel& model, bool gradient, bool slopes, BlockArrays* memory);

  // From f_r to readings, of samples [begin, begin + count) in all channels, kBlock apart.
  void Apply(std::size_t begin, std::size_t count, std::size_t padded, const double* cos_i, double* f);
  // From slopes by the readings to slopes by f_r; keeps the columns of the gains' logarithms.
  void FinishSlopes(std::size_t padded, const double* f, double* slope);
  // The columns of offset and gain in channel c; `slope` by f_r. Returns where the next begins.
  double* Write(std::size_t c, const double* slope, std::size_t padded, double* to) const;

  // Adds products of a gain's column with `count` columns, kBlock apart, to the sums of its group, run by run of
  // samples of one group. `sums_of`: where those of a group are.
  template <class SumsOf>
  void AddGainProducts(std::size_t c, const double* columns, std::size_t count, const SumsOf& sums_of) const {
    const double* gain = gain_column(c);
    for (std::size_t i = 0; i < count_;) {
      const std::uint32_t group = samples_.gain_group[begin_ + i];
      std::size_t j = i + 1;
      while (j < count_ && samples_.gain_group[begin_ + j] == group) ++j;
      double* sums = sums_of(group);
      for (std::size_t k = 0; k < count; ++k)
        sums[k] += std::inner_product(gain + i, gain + j, columns + k * kBlock + i, 0.0);
      i = j;
    }
  }
  const double* gain_column(std::size_t c) const { return gain_column_.data() + c * kBlock; }

 private:
  const KernelSamples& samples_;
  const KernelModel& model_;
  const bool gradient_, slopes_;
  std::size_t begin_ = 0, count_ = 0;
  std::span<double> gain_, gain_column_, inverse_cos_i_, slope_by_reading_;
};

}  // namespace lobefit
