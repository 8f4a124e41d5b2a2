#include "lobefit/fit/kernel/lobe_stage.h"

#include <algorithm>

#include "lobefit/fit/kernel/kernel_arrays.h"

namespace lobefit {

void ContractGradients(const KernelLobe& lobe, std::size_t count, std::size_t padded, double* gradients, double* to) {
  const std::size_t size = ShapeParameters(lobe.kind);
  for (std::size_t j = size; j-- > 0 && count < kBlock;) {
    std::copy_backward(gradients + j * count, gradients + (j + 1) * count, gradients + j * kBlock + count);
    std::fill(gradients + j * kBlock + count, gradients + j * kBlock + padded, 0.0);
  }
  arrays::Contract(gradients, lobe.jacobian.data(), size, lobe.columns, padded, kBlock, to);
}

LobeStage::LobeStage(const KernelModel& model, bool gradient, BlockArrays* memory)
    : model_(model), gradient_(gradient), fresnel_(model, gradient, memory) {
  std::size_t columns = 0, shape = kEllipseParameters;
  bool means = false;
  for (const KernelLobe& lobe : model.lobes) {
    first_.push_back(columns);
    columns += lobe.columns;
    shape = std::max(shape, ShapeParameters(lobe.kind));
    means = means || lobe.mean != nullptr;
  }
  memory->Want(&specular_, model.lobes.size());
  memory->Want(&gradients_, gradient ? shape : 0);
  memory->Want(&contracted_, gradient ? columns : 0);
  memory->Want(&argument_gradients_, means && gradient ? shape : 0);
  memory->Want(&argument_contracted_, means && gradient ? columns : 0);
}

void LobeStage::Evaluate(std::size_t l, const DirectionArrays& directions, std::size_t padded) {
  const KernelLobe& lobe = model_.lobes[l];
  double* value = specular_.data() + l * kBlock;
  double* gradients = gradient_ ? gradients_.data() : nullptr;
  if (lobe.mean != nullptr) {
    double* by_argument = gradient_ ? argument_gradients_.data() : nullptr;
    MeanLobe(directions, lobe.kind, lobe.shape, *lobe.mean, {value, fresnel_.argument(l), gradients, by_argument});
    if (gradient_)
      ContractGradients(lobe, directions.count, padded, by_argument, argument_contracted_.data() + first_[l] * kBlock);
  } else {
    SpecularLobe(directions, lobe.kind, lobe.shape, value, fresnel_.argument(l), gradients);
  }
  std::fill(value + directions.count, value + padded, 0.0);
  fresnel_.Finish(l, directions.count, padded);
  if (gradient_) ContractGradients(lobe, directions.count, padded, gradients, contracted_.data() + first_[l] * kBlock);
}

void LobeStage::AddTo(std::size_t l, std::size_t c, std::size_t padded, double* f) {
  const FresnelStage::Factor factor = fresnel_.Evaluate(l, c, padded);
  arrays::AddFactor(specular(l), factor.constant, factor.slope, factor.array, padded, f);
}

double* LobeStage::WriteShape(std::size_t l, std::size_t c, const double* slope, const FacetColumns& facets,
                              std::size_t padded, double* to) const {
  const KernelLobe& lobe = model_.lobes[l];
  const FresnelStage::Factor factor = fresnel_.FactorOf(l, c);
  arrays::ShapeColumn(slope, factor.constant, factor.slope, factor.array, contracted_.data() + first_[l] * kBlock,
                      facets.albedo, facets.gradients, lobe.columns, padded, kBlock, to);
  if (lobe.mean != nullptr) {
    fresnel_.AddArgumentColumns(l, c, slope, specular(l), argument_contracted_.data() + first_[l] * kBlock, padded, to);
  }
  return to + lobe.columns * kBlock;
}

void LobeStage::WriteFresnel(std::size_t l, std::size_t k, std::size_t c, const double* slope, std::size_t padded,
                             double* to) const {
  arrays::Product(slope, specular(l), fresnel_.Gradient(l, k, c), padded, to);
}

}  // namespace lobefit
