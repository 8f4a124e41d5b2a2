#include "lobefit/fit/kernel/diffuse_stage.h"

#include <algorithm>

#include "lobefit/fit/kernel/kernel_arrays.h"
#include "lobefit/math/vec.h"

namespace lobefit {

DiffuseStage::DiffuseStage(const KernelModel& model, bool gradient, double lambert, bool coated, BlockArrays* memory)
    : model_(model), gradient_(gradient) {
  const bool any = !model.diffuse.empty(), first = !model.lobes.empty();
  const std::size_t size = DiffuseParameters(model.diffuse_kind);
  if (any && IsDirectional(model.diffuse_kind)) {
    for (std::size_t c = 0; c < model.channels; ++c)
      directional_.emplace_back(model.diffuse_kind, model.diffuse.data() + c * size);
  }
  if (any && first && model.diffuse_kind == Diffuse::kMicrofacet)
    facets_.emplace(model.lobes[0].kind, model.lobes[0].shape.slope);
  if (first && !coated && model.diffuse_kind == Diffuse::kLambert && model.lobes[0].mean != nullptr &&
      model.lobes[0].mean->region != nullptr) {
    cut_rule_ = model.lobes[0].mean.get();
  }
  memory->Want(&value_, std::max<std::size_t>(1, directional_.size()), lambert);
  memory->Want(&gradient_values_, gradient ? directional_.size() * size : 0);
  memory->Want(&interfaced_, directional_.empty() ? 0 : 2);
  memory->Want(&facet_gradients_, facets_ && gradient ? ShapeParameters(model.lobes[0].kind) : 0);
  memory->Want(&facet_contracted_, facets_ && gradient ? model.lobes[0].columns : 0);
}

void DiffuseStage::Evaluate(const DirectionArrays& directions, std::size_t padded) {
  for (std::size_t c = 0; c < directional_.size(); ++c) EvaluateChannel(c, directions, padded);
  if (cut_rule_ != nullptr) {
    ConstantMeans(directions, *cut_rule_, value_.data());
    for (std::size_t i = 0; i < directions.count; ++i) value_[i] *= kInvPi;
  }
  if (!facets_) return;
  facets_->Evaluate(directions, value_.data(), gradient_ ? facet_gradients_.data() : nullptr);
  std::fill(value_.begin() + static_cast<std::ptrdiff_t>(directions.count), value_.end(), 0.0);
  if (gradient_) {
    ContractGradients(model_.lobes[0], directions.count, padded, facet_gradients_.data(), facet_contracted_.data());
  }
}

void DiffuseStage::AddTo(std::size_t c, std::size_t padded, double* f) const {
  if (!directional_.empty()) {
    arrays::AddScaled(value_.data() + c * kBlock, 1.0, padded, f);
  } else if (!model_.diffuse.empty()) {
    arrays::AddScaled(value_.data(), model_.diffuse[c], padded, f);
  }
}

FacetColumns DiffuseStage::FacetsOf(std::size_t l, std::size_t c) const {
  if (!facets_ || l > 0) return {};
  return {model_.diffuse[c], facet_contracted_.data()};
}

double* DiffuseStage::Write(std::size_t c, const double* slope, std::size_t padded, double* to) const {
  if (model_.diffuse.empty()) return to;
  const std::size_t size = directional_.empty() ? 1 : DiffuseParameters(model_.diffuse_kind);
  for (std::size_t k = 0; k < size; ++k, to += kBlock)
    arrays::Multiply(slope, directional_.empty() ? value_.data() : gradient(c, k), padded, to);
  return to;
}

void DiffuseStage::EvaluateChannel(std::size_t c, const DirectionArrays& d, std::size_t padded) {
  double* value = value_.data() + c * kBlock;
  if (model_.diffuse_kind == Diffuse::kInterfaced) return EvaluateInterfaced(c, d, padded, value);
  for (std::size_t i = 0; i < d.count; ++i) {
    double by_parameter[2];
    value[i] = directional_[c].Evaluate({d.wi_x[i], d.wi_y[i], d.wi_z[i]}, {d.wo_x[i], d.wo_y[i], d.wo_z[i]},
                                        gradient_ ? by_parameter : nullptr);
    for (std::size_t k = 0; gradient_ && k < 2; ++k) gradient(c, k)[i] = by_parameter[k];
  }
  std::fill(value + d.count, value + padded, 0.0);
  for (std::size_t k = 0; gradient_ && k < 2; ++k) std::fill(gradient(c, k) + d.count, gradient(c, k) + padded, 0.0);
}

// Channels of one interface differ by their albedo.
void DiffuseStage::EvaluateInterfaced(std::size_t c, const DirectionArrays& d, std::size_t padded, double* value) {
  double *unit = interfaced_.data(), *by_ior = unit + kBlock;
  if (c == 0 || !directional_[c].HasInterfaceOf(directional_[c - 1])) {
    directional_[c].EvaluateInterfaced(d.wi_z, d.wo_z, d.count, unit, by_ior);
    std::fill(unit + d.count, unit + padded, 0.0);
    std::fill(by_ior + d.count, by_ior + padded, 0.0);
  }
  std::fill_n(value, padded, 0.0);
  arrays::AddScaled(unit, directional_[c].albedo(), padded, value);
  if (!gradient_) return;
  arrays::Multiply(value, by_ior, padded, gradient(c, 0));
  std::copy_n(unit, padded, gradient(c, 1));
}

}  // namespace lobefit
