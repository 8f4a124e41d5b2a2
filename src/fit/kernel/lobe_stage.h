// The lobes of a block of samples: their values, and their columns by shape and Fresnel parameters. Internal to the
// kernel.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lobefit/fit/kernel/block_arrays.h"
#include "lobefit/fit/kernel/fresnel_stage.h"
#include "lobefit/fit/kernel/kernel.h"

namespace lobefit {

// Gradients by slope coordinates to `lobe`'s solver coordinates. They were written with a stride of `count`: a last,
// shorter block is spread to kBlock first, in place.
void ContractGradients(const KernelLobe& lobe, std::size_t count, std::size_t padded, double* gradients, double* to);

// Columns that a shape has beside its lobe's: of facets that reflect diffusely too. Null: none.
struct FacetColumns {
  double albedo = 0;
  const double* gradients = nullptr;
};

class LobeStage {
 public:
  LobeStage(const KernelModel& model, bool gradient, BlockArrays* memory);

  void Evaluate(std::size_t l, const DirectionArrays& directions, std::size_t padded);
  // f += the lobe in channel c; channels in order.
  void AddTo(std::size_t l, std::size_t c, std::size_t padded, double* f);
  // Columns of the lobe's shape in channel c, kBlock apart, times `slope`. Returns where the next begins.
  double* WriteShape(std::size_t l, std::size_t c, const double* slope, const FacetColumns& facets, std::size_t padded,
                     double* to) const;
  // The column of its k-th Fresnel parameter.
  void WriteFresnel(std::size_t l, std::size_t k, std::size_t c, const double* slope, std::size_t padded,
                    double* to) const;

 private:
  const double* specular(std::size_t l) const { return specular_.data() + l * kBlock; }

  const KernelModel& model_;
  const bool gradient_;
  FresnelStage fresnel_;
  std::vector<std::size_t> first_;  // shape columns before each lobe's
  // Gradients by slope coordinates are of one lobe at a time; contracted ones of all.
  std::span<double> specular_, gradients_, contracted_, argument_gradients_, argument_contracted_;
};

}  // namespace lobefit
