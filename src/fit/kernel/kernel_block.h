// One block of samples in the fit's inner loop: what kernel.cc streams. Internal to it.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lobefit/core/brdf/diffuse.h"
#include "lobefit/core/brdf/diffuse_facets.h"
#include "lobefit/core/brdf/lobe.h"
#include "lobefit/fit/kernel/angle_differences.h"
#include "lobefit/fit/kernel/block_inputs.h"
#include "lobefit/fit/kernel/coat_stage.h"
#include "lobefit/fit/kernel/kernel.h"
#include "lobefit/fit/kernel/kernel_arrays.h"
#include "lobefit/fit/kernel/turned_axes.h"

namespace lobefit {

// 256 samples: the columns of one channel of a one-lobe model take 16 KB, half of a first-level cache.
inline constexpr std::size_t kBlock = 256;

// One block of samples: the model's values, residuals and columns. Arrays of kBlock, padded so that pads add nothing to
// any sum.
class Block {
 public:
  // `slopes`: the derivatives by the gains, which need none of the model's; `gradient` includes them.
  Block(const KernelSamples& samples, const KernelModel& model, bool gradient, bool slopes = false)
      : samples_(samples), model_(model), gradient_(gradient), slopes_(slopes || gradient) {
    const std::size_t lobes = model.lobes.size(), channels = model.channels;
    for (const KernelLobe& lobe : model.lobes) {
      first_fresnel_.push_back(fresnel_size_);
      fresnel_size_ += FresnelParameters(lobe.kind.fresnel);
      first_contracted_.push_back(contracted_size_);
      contracted_size_ += lobe.columns;
      shape_size_ = std::max(shape_size_, ShapeParameters(lobe.kind));
    }
    // Behind the lobes' columns those of the first lobe's facets.
    const std::size_t facets = model.diffuse_kind == Diffuse::kMicrofacet && lobes > 0 ? model.lobes[0].columns : 0;
    const bool directional = IsDirectional(model.diffuse_kind) && !model.diffuse.empty();
    const std::size_t diffuse_size = model.diffuse.empty() ? 0 : DiffuseParameters(model.diffuse_kind);
    means_ = std::any_of(model.lobes.begin(), model.lobes.end(),
                         [](const KernelLobe& lobe) { return lobe.mean != nullptr; });
    const bool linear = std::all_of(model.lobes.begin(), model.lobes.end(), IsLinear);
    // Arrays, and how many blocks each needs, in one piece of memory: a fit of 200 samples is made of passes that take
    // 5 us.
    const std::pair<std::span<double>*, std::size_t> arrays[] = {
        {&specular_, lobes},
        {&gradients_, gradient ? shape_size_ : 0},
        {&contracted_, gradient ? contracted_size_ + facets : 0},
        {&cos_d_, lobes},
        {&argument_gradients_, means_ && gradient ? shape_size_ : 0},
        {&argument_contracted_, means_ && gradient ? contracted_size_ : 0},
        {&diffuse_, directional ? channels : 1},
        {&diffuse_gradient_, directional && gradient ? channels * diffuse_size : 0},
        {&sqrt_weight_, 1},
        {&p5_, lobes},
        {&one_minus_p5_, lobes},
        {&ones_, 1},
        {&factor_, linear ? 0 : channels * lobes},
        {&factor_gradient_, linear ? 0 : channels * fresnel_size_},
        {&curve_basis_, linear ? 0 : lobes * kMaxFresnelParameters},
        {&interfaced_, directional ? 2 : 0},
        {&factor_by_argument_, linear || !means_ ? 0 : channels * lobes},
        {&f_, channels},
        {&residual_, channels},
        {&slope_, slopes_ ? channels : 0},
        {&moved_, model.alignment.angles.empty() ? 0 : 6},
        {&gain_, model.gains ? 1 : 0},
        {&gain_column_, model.gains && slopes_ ? channels : 0},
        {&inverse_cos_i_, model.offset.empty() ? 0 : 1},
        {&reading_slope_, model.offset.empty() || !gradient ? 0 : channels},
        {&columns_, gradient ? model.columns() : 0},
        {&below_slope_, gradient && CoatOf(model) < lobes ? 1 : 0},
    };
    std::size_t blocks = 0;
    for (const auto& [array, count] : arrays) blocks += count;
    memory_ = std::make_unique_for_overwrite<double[]>(blocks * kBlock);
    double* next = memory_.get();
    for (const auto& [array, count] : arrays) {
      *array = {next, count * kBlock};
      next += count * kBlock;
    }
    if (gradient && (!model.alignment.angles.empty() || !model.half_angles.empty()))
      differences_ = std::make_unique<AngleDifferences<Block>>(samples, model, kBlock);
    if (const std::size_t coat = CoatOf(model); coat < lobes) coat_.emplace(model, coat, gradient);
    std::fill(diffuse_.begin(), diffuse_.end(), coat_ ? coat_->lambert() : kInvPi);
    std::fill(ones_.begin(), ones_.end(), 1.0);
    const bool constant = model.diffuse_kind == Diffuse::kLambert && !coat_ && lobes > 0;
    if (constant && model.lobes[0].mean != nullptr && model.lobes[0].mean->region != nullptr)
      cut_rule_ = model.lobes[0].mean.get();
    if (model.diffuse_kind == Diffuse::kMicrofacet && !model.diffuse.empty())
      facets_.emplace(model.lobes[0].kind, model.lobes[0].shape.slope);
    for (std::size_t c = 0; directional && c < channels; ++c)
      directional_.emplace_back(model.diffuse_kind, model.diffuse.data() + c * diffuse_size);
  }

  // Values of samples [begin, begin + count), count <= kBlock.
  void Evaluate(std::size_t begin, std::size_t count) {
    count_ = count;
    padded_ = (count + 7) / 8 * 8;  // no target has more than 8 lanes
    DirectionArrays directions = {};
    const double** fields[] = {&directions.wi_x, &directions.wi_y, &directions.wi_z,
                               &directions.wo_x, &directions.wo_y, &directions.wo_z};
    for (std::size_t k = 0; k < 6; ++k) *fields[k] = samples_.direction[k] + begin;
    directions.count = count;
    // The irradiance is the nominal one, however the sample stands.
    cos_i_ = Padded(directions.wi_z, 0.0, &cos_i_pad_);
    if (!model_.alignment.angles.empty()) {
      TurnDirections(TurnsOf(model_.alignment.azimuths, model_.alignment.angles), samples_.direction, samples_.turn,
                     begin, count_, kBlock, moved_.data());
      for (std::size_t k = 0; k < 6; ++k) *fields[k] = moved_.data() + k * kBlock;
    }
    if (differences_ != nullptr) differences_->Evaluate(begin, count);
    const DirectionArrays below = coat_ ? coat_->Enter(directions) : directions;
    for (std::size_t l = 0; l < model_.lobes.size(); ++l)
      EvaluateLobe(l, IsCoat(model_.lobes[l].kind.fresnel) ? directions : below);
    for (std::size_t c = 0; c < directional_.size(); ++c) EvaluateDiffuse(c, directions);
    if (cut_rule_ != nullptr) {
      ConstantMeans(directions, *cut_rule_, diffuse_.data());
      for (std::size_t i = 0; i < count_; ++i) diffuse_[i] *= kInvPi;
    }
    if (facets_) {
      facets_->Evaluate(directions, diffuse_.data(), gradient_ ? gradients_.data() : nullptr);
      std::fill(diffuse_.begin() + static_cast<std::ptrdiff_t>(count_), diffuse_.end(), 0.0);
      if (gradient_) ContractGradients(0, gradients_.data(), diffuse_contracted());
    }
    for (std::size_t c = 0; c < model_.channels; ++c) {
      double* f = f_.data() + c * kBlock;
      std::fill_n(f, padded_, 0.0);
      if (!directional_.empty()) {
        arrays::AddScaled(diffuse_.data() + c * kBlock, 1.0, padded_, f);
      } else if (!model_.diffuse.empty()) {
        arrays::AddScaled(diffuse_.data(), model_.diffuse[c], padded_, f);
      }
      const auto add_lobes = [&](bool coat) {
        for (std::size_t l = 0; l < model_.lobes.size(); ++l) {
          if (IsCoat(model_.lobes[l].kind.fresnel) != coat) continue;
          const Factor factor = EvaluateFresnel(l, c);
          arrays::AddFactor(specular_.data() + l * kBlock, factor.constant, factor.slope, factor.array, padded_, f);
        }
      };
      add_lobes(false);
      if (!coat_) continue;
      coat_->Cover(c, padded_, f);
      add_lobes(true);
    }
    if (model_.gains) ApplyGains(begin);
    if (!model_.offset.empty()) AddOffset();
  }

  // Residuals (and slopes), reweighted by the loss. Returns the sum of rho.
  double Residuals(std::size_t begin, double* sum_robust_weight) {
    const double* sqrt_weight = SqrtWeight(begin);
    for (std::size_t c = 0; c < model_.channels; ++c) {
      const double* measured = Padded(samples_.measured[c] + begin, 1.0, &measured_pad_);
      lobefit::Residuals(model_.transform, f_.data() + c * kBlock, cos_i_, measured, sqrt_weight, padded_,
                         residual_.data() + c * kBlock, slopes_ ? slope_.data() + c * kBlock : nullptr);
    }
    double sum = 0;
    if (model_.loss == Loss::kNone) {
      for (std::size_t c = 0; c < model_.channels; ++c)
        sum += arrays::SumOfSquares(residual_.data() + c * kBlock, padded_);
      *sum_robust_weight += static_cast<double>(count_);
      if (model_.gains && slopes_) FinishGains();
      return sum;
    }
    for (std::size_t i = 0; i < count_; ++i) {
      double s = 0;
      for (std::size_t c = 0; c < model_.channels; ++c) s += residual_[c * kBlock + i] * residual_[c * kBlock + i];
      const LossValue loss = EvaluateLoss(model_.loss, model_.loss_scale, s);
      sum += loss.rho;
      *sum_robust_weight += loss.first;
      const double root = std::sqrt(loss.first);
      for (std::size_t c = 0; c < model_.channels; ++c) {
        residual_[c * kBlock + i] *= root;
        if (slopes_) slope_[c * kBlock + i] *= root;
      }
    }
    if (model_.gains && slopes_) FinishGains();
    return sum;
  }

  // Columns of one channel, kBlock apart; the last is the residual.
  const double* Columns(std::size_t c) {
    const double* const outside = slope_.data() + c * kBlock;
    // By what lies below a coat.
    if (coat_) arrays::Multiply(outside, coat_->through(c), padded_, below_slope_.data());
    const double* const slope = coat_ ? below_slope_.data() : outside;
    const auto slope_of = [&](std::size_t l) { return IsCoat(model_.lobes[l].kind.fresnel) ? outside : slope; };
    double* to = columns_.data();
    for (std::size_t l = 0; l < model_.lobes.size(); ++l) {
      const bool facets = facets_ && l == 0;
      const Factor factor = FactorOf(l, c);
      arrays::ShapeColumn(slope_of(l), factor.constant, factor.slope, factor.array, contracted(l),
                          facets ? model_.diffuse[c] : 0.0, facets ? diffuse_contracted() : nullptr,
                          model_.lobes[l].columns, padded_, kBlock, to);
      if (model_.lobes[l].mean != nullptr) AddArgumentColumns(l, c, slope_of(l), to);
      to += model_.lobes[l].columns * kBlock;
    }
    for (std::size_t k = 0; differences_ != nullptr && k < differences_->size(); ++k, to += kBlock)
      arrays::Multiply(outside, differences_->column(k, c), padded_, to);
    for (std::size_t l = 0; l < model_.lobes.size(); ++l) {
      for (std::size_t k = 0; k < FresnelParameters(model_.lobes[l].kind.fresnel); ++k, to += kBlock) {
        arrays::Product(slope_of(l), specular_.data() + l * kBlock, FactorGradient(l, k, c), padded_, to);
        if (!IsCoat(model_.lobes[l].kind.fresnel)) continue;
        arrays::AddFactor(outside, 0, 1, coat_->gradient(c, k), padded_, to);
      }
    }
    for (std::size_t k = 0; k < (directional_.empty() ? 0 : DiffuseParameters(model_.diffuse_kind)); ++k, to += kBlock)
      arrays::Multiply(slope, diffuse_gradient(c, k), padded_, to);
    if (directional_.empty() && !model_.diffuse.empty()) {
      arrays::Multiply(slope, diffuse_.data(), padded_, to);
      to += kBlock;
    }
    if (!model_.offset.empty()) {
      // By the reading, which a gain does not scale.
      const double* by_reading = model_.gains ? reading_slope_.data() + c * kBlock : outside;
      arrays::Multiply(by_reading, inverse_cos_i_.data(), padded_, to);
      to += kBlock;
    }
    if (model_.gains) {
      std::copy_n(gain_column_.data() + c * kBlock, padded_, to);
      to += kBlock;
    }
    std::copy_n(residual_.data() + c * kBlock, padded_, to);
    return columns_.data();
  }

  // Adds products of a gain's column with `count` columns, kBlock apart, to the sums of its group, run by run of
  // samples of one group. `sums`: where those of a group are.
  template <class SumsOf>
  void AddGainProducts(std::size_t begin, std::size_t c, const double* columns, std::size_t count,
                       const SumsOf& sums_of) const {
    const double* gain = gain_column_.data() + c * kBlock;
    for (std::size_t i = 0; i < count_;) {
      const std::uint32_t group = samples_.gain_group[begin + i];
      std::size_t j = i + 1;
      while (j < count_ && samples_.gain_group[begin + j] == group) ++j;
      double* sums = sums_of(group);
      for (std::size_t k = 0; k < count; ++k)
        sums[k] += std::inner_product(gain + i, gain + j, columns + k * kBlock + i, 0.0);
      i = j;
    }
  }
  const double* gain_column(std::size_t c) const { return gain_column_.data() + c * kBlock; }
  const double* residual(std::size_t c) const { return residual_.data() + c * kBlock; }

  std::size_t padded() const { return padded_; }
  const double* f(std::size_t c) const { return f_.data() + c * kBlock; }

 private:
  // The reading f_r cos_theta_i is too high by the offset.
  void AddOffset() {
    std::fill(inverse_cos_i_.begin(), inverse_cos_i_.end(), 0.0);
    for (std::size_t i = 0; i < count_; ++i) inverse_cos_i_[i] = 1 / cos_i_[i];
    for (std::size_t c = 0; c < model_.channels; ++c)
      arrays::AddScaled(inverse_cos_i_.data(), model_.offset[c], padded_, f_.data() + c * kBlock);
  }

  // What the instrument makes of f_r: the reading is g f_r.
  void ApplyGains(std::size_t begin) {
    std::fill(gain_.begin(), gain_.end(), 1.0);
    for (std::size_t i = 0; samples_.gain != nullptr && i < count_; ++i)
      gain_[i] = samples_.gain[samples_.gain_group[begin + i]];
    for (std::size_t c = 0; c < model_.channels; ++c) {
      double* f = f_.data() + c * kBlock;
      arrays::Multiply(gain_.data(), f, padded_, f);
    }
  }

  // The columns of the gains' logarithms, and slopes by f_r in place of those by the reading.
  void FinishGains() {
    for (std::size_t c = 0; c < model_.channels; ++c) {
      double *slope = slope_.data() + c * kBlock, *column = gain_column_.data() + c * kBlock;
      arrays::Multiply(slope, f_.data() + c * kBlock, padded_, column);
      if (!model_.offset.empty()) {
        // An offset is not scaled by the gain.
        for (std::size_t i = 0; i < padded_; ++i) column[i] -= slope[i] * model_.offset[c] * inverse_cos_i_[i];
        if (gradient_) std::copy_n(slope, padded_, reading_slope_.data() + c * kBlock);
      }
      arrays::Multiply(gain_.data(), slope, padded_, slope);
    }
  }

  void EvaluateLobe(std::size_t l, const DirectionArrays& directions) {
    const KernelLobe& lobe = model_.lobes[l];
    double *specular = specular_.data() + l * kBlock, *argument = cos_d_.data() + l * kBlock;
    double* gradients = gradient_ ? gradients_.data() : nullptr;
    if (lobe.mean != nullptr) {
      MeanLobe(directions, lobe.kind, lobe.shape, *lobe.mean,
               {specular, argument, gradients, gradient_ ? argument_gradients_.data() : nullptr});
      if (gradient_) ContractGradients(l, argument_gradients_.data(), argument_contracted(l));
    } else {
      SpecularLobe(directions, lobe.kind, lobe.shape, specular, argument, gradients);
    }
    std::fill(specular + count_, specular + padded_, 0.0);
    std::fill(argument + count_, argument + padded_, 1.0);
    if (IsLinear(lobe)) FinishArgument(l);
    if (IsCurve(lobe)) arrays::CurveBasis(argument, padded_, kBlock, curve_basis(l));
    if (gradient_) ContractGradients(l, gradients, contracted(l));
  }

  // What linear Fresnel factors need of their argument: its power, at a point of the cosine, of a mean as it came.
  void FinishArgument(std::size_t l) {
    double *argument = cos_d_.data() + l * kBlock, *p5 = p5_.data() + l * kBlock,
           *rest = one_minus_p5_.data() + l * kBlock;
    if (model_.lobes[l].mean == nullptr) return arrays::Schlick(argument, padded_, p5, rest);
    std::copy_n(argument, padded_, p5);
    for (std::size_t i = 0; i < padded_; ++i) rest[i] = 1 - p5[i];
  }

  // The shape moves the Fresnel factor of a mean too: to[k] += slope specular dF/d(argument) d(argument)/d(shape k).
  void AddArgumentColumns(std::size_t l, std::size_t c, const double* slope, double* to) {
    const KernelLobe& lobe = model_.lobes[l];
    const bool is_linear = IsLinear(lobe);
    if (lobe.kind.fresnel == Fresnel::kNone) return;
    const double* by_argument =
        is_linear ? nullptr : factor_by_argument_.data() + (c * model_.lobes.size() + l) * kBlock;
    for (std::size_t k = 0; k < lobe.columns; ++k) {
      arrays::AddArgumentColumn(slope, specular_.data() + l * kBlock, is_linear ? LinearFactor(l, c).slope : 1.0,
                                by_argument, argument_contracted(l) + k * kBlock, padded_, to + k * kBlock);
    }
  }

  void EvaluateDiffuse(std::size_t c, const DirectionArrays& d) {
    double* value = diffuse_.data() + c * kBlock;
    if (model_.diffuse_kind == Diffuse::kInterfaced) return EvaluateInterfaced(c, d, value);
    for (std::size_t i = 0; i < count_; ++i) {
      double gradient[2];
      value[i] = directional_[c].Evaluate({d.wi_x[i], d.wi_y[i], d.wi_z[i]}, {d.wo_x[i], d.wo_y[i], d.wo_z[i]},
                                          gradient_ ? gradient : nullptr);
      for (std::size_t k = 0; gradient_ && k < 2; ++k) diffuse_gradient(c, k)[i] = gradient[k];
    }
    std::fill(value + count_, value + padded_, 0.0);
    for (std::size_t k = 0; gradient_ && k < 2; ++k)
      std::fill(diffuse_gradient(c, k) + count_, diffuse_gradient(c, k) + padded_, 0.0);
  }

  // Channels of one interface differ by their albedo.
  void EvaluateInterfaced(std::size_t c, const DirectionArrays& d, double* value) {
    double *unit = interfaced_.data(), *by_ior = unit + kBlock;
    if (c == 0 || !directional_[c].HasInterfaceOf(directional_[c - 1])) {
      directional_[c].EvaluateInterfaced(d.wi_z, d.wo_z, count_, unit, by_ior);
      std::fill(unit + count_, unit + padded_, 0.0);
      std::fill(by_ior + count_, by_ior + padded_, 0.0);
    }
    std::fill_n(value, padded_, 0.0);
    arrays::AddScaled(unit, directional_[c].albedo(), padded_, value);
    if (!gradient_) return;
    arrays::Multiply(value, by_ior, padded_, diffuse_gradient(c, 0));
    std::copy_n(unit, padded_, diffuse_gradient(c, 1));
  }

  // Gradients by slope coordinates to the solver's coordinates of lobe l. They were written with a stride of `count_`:
  // the last, shorter block is spread to kBlock first.
  void ContractGradients(std::size_t l, double* gradients, double* to) {
    const std::size_t size = ShapeParameters(model_.lobes[l].kind);
    for (std::size_t j = size; j-- > 0 && count_ < kBlock;) {
      std::copy_backward(gradients + j * count_, gradients + (j + 1) * count_, gradients + j * kBlock + count_);
      std::fill(gradients + j * kBlock + count_, gradients + j * kBlock + padded_, 0.0);
    }
    arrays::Contract(gradients, model_.lobes[l].jacobian.data(), size, model_.lobes[l].columns, padded_, kBlock, to);
  }

  // Fresnel factor of lobe l in channel c, constant + slope * array; for kinds that are not linear in their parameters
  // evaluated here, with their derivatives.
  struct Factor {
    double constant, slope;
    const double* array;
  };
  Factor EvaluateFresnel(std::size_t l, std::size_t c) {
    const KernelLobe& lobe = model_.lobes[l];
    if (IsLinear(lobe)) return LinearFactor(l, c);
    const std::size_t size = FresnelParameters(lobe.kind.fresnel);
    double* value = factor_.data() + (c * model_.lobes.size() + l) * kBlock;
    if (IsCurve(lobe)) {
      arrays::Contract(curve_basis(l), lobe.fresnel.data() + c * size, size, 1, padded_, kBlock, value);
      return {0, 1, value};
    }
    // A coat's index is common to the channels.
    const bool again = IsCoat(lobe.kind.fresnel) && c > 0 && lobe.mean == nullptr;
    if (again) std::copy_n(factor_.data() + l * kBlock, padded_, value);
    if (again && gradient_)
      std::copy_n(factor_gradient(0, first_fresnel_[l]), size * kBlock, factor_gradient(c, first_fresnel_[l]));
    for (std::size_t i = 0; !again && i < padded_; ++i) {
      double dF[kMaxFresnelParameters];
      double* by_argument = gradient_ && lobe.mean != nullptr
                                ? &factor_by_argument_[(c * model_.lobes.size() + l) * kBlock + i]
                                : nullptr;
      value[i] = FresnelFactor(lobe.kind.fresnel, lobe.fresnel.data() + c * size, cos_d_[l * kBlock + i],
                               gradient_ ? dF : nullptr, by_argument);
      for (std::size_t k = 0; gradient_ && k < size; ++k) factor_gradient(c, first_fresnel_[l] + k)[i] = dF[k];
    }
    return {0, 1, value};
  }
  double* curve_basis(std::size_t l) { return curve_basis_.data() + l * kMaxFresnelParameters * kBlock; }
  Factor LinearFactor(std::size_t l, std::size_t c) const {
    const KernelLobe& lobe = model_.lobes[l];
    if (lobe.kind.fresnel == Fresnel::kNone) return {lobe.fresnel[c], 0, ones_.data()};
    return {lobe.fresnel[c], 1 - lobe.fresnel[c], p5_.data() + l * kBlock};
  }
  Factor FactorOf(std::size_t l, std::size_t c) const {
    if (IsLinear(model_.lobes[l])) return LinearFactor(l, c);
    return {0, 1, factor_.data() + (c * model_.lobes.size() + l) * kBlock};
  }
  // Derivative of the factor by the k-th parameter of lobe l.
  const double* FactorGradient(std::size_t l, std::size_t k, std::size_t c) {
    if (model_.lobes[l].kind.fresnel == Fresnel::kNone) return ones_.data();
    if (model_.lobes[l].kind.fresnel == Fresnel::kSchlick) return one_minus_p5_.data() + l * kBlock;
    if (IsCurve(model_.lobes[l])) return curve_basis(l) + k * kBlock;
    return factor_gradient(c, first_fresnel_[l] + k);
  }
  double* factor_gradient(std::size_t c, std::size_t k) {
    return factor_gradient_.data() + (c * fresnel_size_ + k) * kBlock;
  }
  double* contracted(std::size_t l) { return contracted_.data() + first_contracted_[l] * kBlock; }
  double* argument_contracted(std::size_t l) { return argument_contracted_.data() + first_contracted_[l] * kBlock; }
  double* diffuse_contracted() { return contracted_.data() + contracted_size_ * kBlock; }
  double* diffuse_gradient(std::size_t c, std::size_t k) {
    return diffuse_gradient_.data() + (c * DiffuseParameters(model_.diffuse_kind) + k) * kBlock;
  }

  // Square roots of the weights of this block, 0 for pads; null where all are 1.
  const double* SqrtWeight(std::size_t begin) {
    if (!HasWeights(samples_) && padded_ == count_) return nullptr;
    const double* cos_o = samples_.sin_o ? Padded(samples_.direction[5] + begin, 0.0, &cos_o_pad_) : nullptr;
    WriteWeightRoots(samples_, begin, count_, padded_, cos_i_, cos_o, sqrt_weight_);
    return sqrt_weight_.data();
  }

  const double* Padded(const double* from, double pad, std::vector<double>* copy) const {
    return PaddedArray(from, count_, padded_, pad, copy);
  }

  const KernelSamples& samples_;
  const KernelModel& model_;
  const bool gradient_, slopes_;
  std::size_t count_ = 0, padded_ = 0;
  const double* cos_i_ = nullptr;
  std::optional<DiffuseFacets> facets_;
  std::optional<CoatStage> coat_;
  const LobeMeanRule* cut_rule_ = nullptr;       // of discs that the horizon may cut, over a Lambert part; null: none
  std::vector<DirectionalDiffuse> directional_;  // [channel]
  std::size_t shape_size_ = kEllipseParameters;  // most of a lobe
  std::size_t contracted_size_ = 0;              // columns of all lobes' shapes
  std::vector<std::size_t> first_contracted_;    // of each lobe
  std::size_t fresnel_size_ = 0;                 // of all lobes
  std::vector<std::size_t> first_fresnel_;       // of each lobe
  std::unique_ptr<double[]> memory_;
  bool means_ = false;  // some lobe is averaged over the instrument's discs
  // cos_d_: of each lobe's pair; of a mean its Fresnel argument.
  std::span<double> specular_, gradients_, contracted_, cos_d_, p5_, one_minus_p5_, ones_, factor_, factor_gradient_,
      curve_basis_, interfaced_, diffuse_, diffuse_gradient_;
  std::span<double> argument_gradients_, argument_contracted_, factor_by_argument_;
  std::span<double> f_, residual_, slope_, columns_, sqrt_weight_, gain_, gain_column_, inverse_cos_i_, reading_slope_,
      below_slope_;
  std::span<double> moved_;  // directions in the sample's frame, where it stands crooked
  std::unique_ptr<AngleDifferences<Block>> differences_;
  std::vector<double> cos_i_pad_, cos_o_pad_, measured_pad_;
};

}  // namespace lobefit
