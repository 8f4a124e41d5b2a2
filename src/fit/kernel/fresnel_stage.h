// Fresnel factors of a block's lobes, with their derivatives. Internal to the kernel.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lobefit/fit/kernel/block_arrays.h"
#include "lobefit/fit/kernel/kernel.h"

namespace lobefit {

class FresnelStage {
 public:
  FresnelStage(const KernelModel& model, bool gradient, BlockArrays* memory);

  // Where the lobe's evaluation writes the factor's argument: cos theta_d; of a mean over discs what its kind asks for.
  double* argument(std::size_t l) { return argument_.data() + l * kBlock; }
  // Once `count` of them stand there.
  void Finish(std::size_t l, std::size_t count, std::size_t padded);

  // constant + slope * array.
  struct Factor {
    double constant, slope;
    const double* array;
  };
  // The factor in channel c of a lobe that is finished, with its derivatives; channels in order.
  Factor Evaluate(std::size_t l, std::size_t c, std::size_t padded);
  // That again, once it was evaluated.
  Factor FactorOf(std::size_t l, std::size_t c) const;
  // Its derivative by the k-th parameter.
  const double* Gradient(std::size_t l, std::size_t k, std::size_t c) const;

  // The shape moves the factor of a mean too: to[k] += slope specular dF/d(argument) gradients[k], these d(argument) /
  // d(shape k).
  void AddArgumentColumns(std::size_t l, std::size_t c, const double* slope, const double* specular,
                          const double* gradients, std::size_t padded, double* to) const;

 private:
  Factor LinearFactor(std::size_t l, std::size_t c) const;
  std::size_t Place(std::size_t l, std::size_t c) const { return (c * model_.lobes.size() + l) * kBlock; }
  std::size_t GradientPlace(std::size_t l, std::size_t k, std::size_t c) const {
    return (c * size_ + first_[l] + k) * kBlock;
  }
  double* curve_basis(std::size_t l) { return curve_basis_.data() + l * kMaxFresnelParameters * kBlock; }
  const double* curve_basis(std::size_t l) const { return curve_basis_.data() + l * kMaxFresnelParameters * kBlock; }

  const KernelModel& model_;
  const bool gradient_;
  std::size_t size_ = 0;            // parameters of all lobes
  std::vector<std::size_t> first_;  // of each lobe
  std::span<double> argument_, p5_, one_minus_p5_, ones_, value_, value_gradient_, by_argument_, curve_basis_;
};

}  // namespace lobefit
