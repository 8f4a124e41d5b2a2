#include "lobefit/fit/kernel/fresnel_stage.h"

#include <algorithm>

#include "lobefit/fit/kernel/kernel_arrays.h"

namespace lobefit {
namespace {

// Factors that are constant + slope * (1 - cos_d)^5.
bool IsLinear(const KernelLobe& lobe) {
  return lobe.kind.fresnel == Fresnel::kSchlick || lobe.kind.fresnel == Fresnel::kNone;
}
// A curve at a point: of a mean the argument moves with the shape.
bool IsCurve(const KernelLobe& lobe) { return lobe.kind.fresnel == Fresnel::kCurve && lobe.mean == nullptr; }

}  // namespace

FresnelStage::FresnelStage(const KernelModel& model, bool gradient, BlockArrays* memory)
    : model_(model), gradient_(gradient) {
  const std::size_t lobes = model.lobes.size(), channels = model.channels;
  bool linear = true, means = false;
  for (const KernelLobe& lobe : model.lobes) {
    first_.push_back(size_);
    size_ += FresnelParameters(lobe.kind.fresnel);
    linear = linear && IsLinear(lobe);
    means = means || lobe.mean != nullptr;
  }
  memory->Want(&argument_, lobes);
  memory->Want(&p5_, lobes);
  memory->Want(&one_minus_p5_, lobes);
  memory->Want(&ones_, 1, 1.0);
  if (linear) return;
  memory->Want(&value_, channels * lobes);
  memory->Want(&value_gradient_, channels * size_);
  memory->Want(&curve_basis_, lobes * kMaxFresnelParameters);
  memory->Want(&by_argument_, means ? channels * lobes : 0);
}

void FresnelStage::Finish(std::size_t l, std::size_t count, std::size_t padded) {
  const KernelLobe& lobe = model_.lobes[l];
  double *at = argument(l), *p5 = p5_.data() + l * kBlock, *rest = one_minus_p5_.data() + l * kBlock;
  std::fill(at + count, at + padded, 1.0);
  if (IsCurve(lobe)) arrays::CurveBasis(at, padded, kBlock, curve_basis(l));
  if (!IsLinear(lobe)) return;
  // Its power at a point of the cosine; of a mean as it came.
  if (lobe.mean == nullptr) return arrays::Schlick(at, padded, p5, rest);
  std::copy_n(at, padded, p5);
  for (std::size_t i = 0; i < padded; ++i) rest[i] = 1 - p5[i];
}

FresnelStage::Factor FresnelStage::Evaluate(std::size_t l, std::size_t c, std::size_t padded) {
  const KernelLobe& lobe = model_.lobes[l];
  if (IsLinear(lobe)) return LinearFactor(l, c);
  const std::size_t size = FresnelParameters(lobe.kind.fresnel);
  const double* parameters = lobe.fresnel.data() + c * size;
  double* value = value_.data() + Place(l, c);
  if (IsCurve(lobe)) {
    arrays::Contract(curve_basis(l), parameters, size, 1, padded, kBlock, value);
    return {0, 1, value};
  }
  double* gradient = value_gradient_.data() + GradientPlace(l, 0, c);
  // A coat's index is common to the channels.
  const bool again = IsCoat(lobe.kind.fresnel) && c > 0 && lobe.mean == nullptr;
  if (again) std::copy_n(value_.data() + Place(l, 0), padded, value);
  if (again && gradient_) std::copy_n(value_gradient_.data() + GradientPlace(l, 0, 0), size * kBlock, gradient);
  for (std::size_t i = 0; !again && i < padded; ++i) {
    double dF[kMaxFresnelParameters];
    double* by_argument = gradient_ && lobe.mean != nullptr ? &by_argument_[Place(l, c) + i] : nullptr;
    value[i] =
        FresnelFactor(lobe.kind.fresnel, parameters, argument_[l * kBlock + i], gradient_ ? dF : nullptr, by_argument);
    for (std::size_t k = 0; gradient_ && k < size; ++k) gradient[k * kBlock + i] = dF[k];
  }
  return {0, 1, value};
}

FresnelStage::Factor FresnelStage::LinearFactor(std::size_t l, std::size_t c) const {
  const KernelLobe& lobe = model_.lobes[l];
  if (lobe.kind.fresnel == Fresnel::kNone) return {lobe.fresnel[c], 0, ones_.data()};
  return {lobe.fresnel[c], 1 - lobe.fresnel[c], p5_.data() + l * kBlock};
}

FresnelStage::Factor FresnelStage::FactorOf(std::size_t l, std::size_t c) const {
  if (IsLinear(model_.lobes[l])) return LinearFactor(l, c);
  return {0, 1, value_.data() + Place(l, c)};
}

const double* FresnelStage::Gradient(std::size_t l, std::size_t k, std::size_t c) const {
  const KernelLobe& lobe = model_.lobes[l];
  if (lobe.kind.fresnel == Fresnel::kNone) return ones_.data();
  if (lobe.kind.fresnel == Fresnel::kSchlick) return one_minus_p5_.data() + l * kBlock;
  if (IsCurve(lobe)) return curve_basis(l) + k * kBlock;
  return value_gradient_.data() + GradientPlace(l, k, c);
}

void FresnelStage::AddArgumentColumns(std::size_t l, std::size_t c, const double* slope, const double* specular,
                                      const double* gradients, std::size_t padded, double* to) const {
  const KernelLobe& lobe = model_.lobes[l];
  if (lobe.kind.fresnel == Fresnel::kNone) return;
  const bool linear = IsLinear(lobe);
  const double scale = linear ? LinearFactor(l, c).slope : 1.0;
  const double* by_argument = linear ? nullptr : by_argument_.data() + Place(l, c);
  for (std::size_t k = 0; k < lobe.columns; ++k) {
    arrays::AddArgumentColumn(slope, specular, scale, by_argument, gradients + k * kBlock, padded, to + k * kBlock);
  }
}

}  // namespace lobefit
