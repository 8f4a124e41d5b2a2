// The diffuse part of a block of samples. Internal to the kernel.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "lobefit/core/brdf/diffuse.h"
#include "lobefit/core/brdf/diffuse_facets.h"
#include "lobefit/fit/kernel/block_arrays.h"
#include "lobefit/fit/kernel/kernel.h"
#include "lobefit/fit/kernel/lobe_stage.h"

namespace lobefit {

class DiffuseStage {
 public:
  // `lambert`: f_r of a Lambertian part of albedo 1, 1/sr; `coated`: a coat lies over it.
  DiffuseStage(const KernelModel& model, bool gradient, double lambert, bool coated, BlockArrays* memory);

  void Evaluate(const DirectionArrays& directions, std::size_t padded);
  // f += the diffuse part of channel c.
  void AddTo(std::size_t c, std::size_t padded, double* f) const;
  // What the shape of lobe l moves of it, in channel c.
  FacetColumns FacetsOf(std::size_t l, std::size_t c) const;
  // Columns of its parameters in channel c, times `slope`. Returns where the next begins.
  double* Write(std::size_t c, const double* slope, std::size_t padded, double* to) const;

 private:
  void EvaluateChannel(std::size_t c, const DirectionArrays& directions, std::size_t padded);
  void EvaluateInterfaced(std::size_t c, const DirectionArrays& directions, std::size_t padded, double* value);
  double* gradient(std::size_t c, std::size_t k) {
    return gradient_values_.data() + (c * DiffuseParameters(model_.diffuse_kind) + k) * kBlock;
  }
  const double* gradient(std::size_t c, std::size_t k) const {
    return gradient_values_.data() + (c * DiffuseParameters(model_.diffuse_kind) + k) * kBlock;
  }

  const KernelModel& model_;
  const bool gradient_;
  std::optional<DiffuseFacets> facets_;
  const LobeMeanRule* cut_rule_ = nullptr;       // of discs that the horizon may cut, over a Lambert part; null: none
  std::vector<DirectionalDiffuse> directional_;  // [channel]
  // Of each channel where it is directional, else of albedo 1; the facets' gradients by slope and solver coordinates.
  std::span<double> value_, gradient_values_, interfaced_, facet_gradients_, facet_contracted_;
};

}  // namespace lobefit
