#include "lobefit/fit/kernel/kernel_block.h"

#include <algorithm>
#include <cmath>

#include "lobefit/fit/kernel/angle_differences.h"
#include "lobefit/fit/kernel/block_inputs.h"
#include "lobefit/fit/kernel/kernel_arrays.h"
#include "lobefit/fit/kernel/turned_axes.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

std::optional<CoatStage> MakeCoat(const KernelModel& model, bool gradient) {
  const std::size_t coat = CoatOf(model);
  if (coat == model.lobes.size()) return std::nullopt;
  return CoatStage(model, coat, gradient);
}

}  // namespace

Block::Block(const KernelSamples& samples, const KernelModel& model, bool gradient, bool slopes)
    : samples_(samples),
      model_(model),
      slopes_(slopes || gradient),
      coat_(MakeCoat(model, gradient)),
      lobes_(model, gradient, &memory_),
      diffuse_(model, gradient, coat_ ? coat_->lambert() : kInvPi, coat_.has_value(), &memory_),
      reading_(samples, model, gradient, slopes, &memory_) {
  memory_.Want(&f_, model.channels);
  memory_.Want(&residual_, model.channels);
  memory_.Want(&slope_, slopes_ ? model.channels : 0);
  memory_.Want(&columns_, gradient ? model.columns() : 0);
  memory_.Want(&sqrt_weight_, 1);
  memory_.Want(&below_slope_, coat_ && gradient ? 1 : 0);
  memory_.Want(&moved_, model.alignment.angles.empty() ? 0 : 6);
  memory_.Allocate();
  if (gradient && (!model.alignment.angles.empty() || !model.half_angles.empty()))
    differences_ = std::make_unique<AngleDifferences>(samples, model);
}

Block::~Block() = default;

void Block::Evaluate(std::size_t begin, std::size_t count) {
  count_ = count;
  padded_ = (count + 7) / 8 * 8;  // no target has more than 8 lanes
  DirectionArrays directions = {};
  const double** fields[] = {&directions.wi_x, &directions.wi_y, &directions.wi_z,
                             &directions.wo_x, &directions.wo_y, &directions.wo_z};
  for (std::size_t k = 0; k < 6; ++k) *fields[k] = samples_.direction[k] + begin;
  directions.count = count;
  // The irradiance is the nominal one, however the sample stands.
  cos_i_ = PaddedArray(directions.wi_z, count_, padded_, 0.0, &cos_i_pad_);
  if (!model_.alignment.angles.empty()) {
    TurnDirections(TurnsOf(model_.alignment.azimuths, model_.alignment.angles), samples_.direction, samples_.turn,
                   begin, count_, kBlock, moved_.data());
    for (std::size_t k = 0; k < 6; ++k) *fields[k] = moved_.data() + k * kBlock;
  }
  if (differences_ != nullptr) differences_->Evaluate(begin, count);
  const DirectionArrays below = coat_ ? coat_->Enter(directions) : directions;
  const auto is_coat = [this](std::size_t l) { return IsCoat(model_.lobes[l].kind.fresnel); };
  for (std::size_t l = 0; l < model_.lobes.size(); ++l) lobes_.Evaluate(l, is_coat(l) ? directions : below, padded_);
  diffuse_.Evaluate(directions, padded_);
  for (std::size_t c = 0; c < model_.channels; ++c) {
    double* f = f_.data() + c * kBlock;
    std::fill_n(f, padded_, 0.0);
    diffuse_.AddTo(c, padded_, f);
    for (std::size_t l = 0; l < model_.lobes.size(); ++l) {
      if (!is_coat(l)) lobes_.AddTo(l, c, padded_, f);
    }
    if (!coat_) continue;
    coat_->Cover(c, padded_, f);
    lobes_.AddTo(CoatOf(model_), c, padded_, f);
  }
  reading_.Apply(begin, count_, padded_, cos_i_, f_.data());
}

double Block::Residuals(std::size_t begin, double* sum_robust_weight) {
  const double* sqrt_weight = SqrtWeight(begin);
  for (std::size_t c = 0; c < model_.channels; ++c) {
    const double* measured = PaddedArray(samples_.measured[c] + begin, count_, padded_, 1.0, &measured_pad_);
    lobefit::Residuals(model_.transform, f_.data() + c * kBlock, cos_i_, measured, sqrt_weight, padded_,
                       residual_.data() + c * kBlock, slopes_ ? slope_.data() + c * kBlock : nullptr);
  }
  double sum = 0;
  if (model_.loss == Loss::kNone) {
    for (std::size_t c = 0; c < model_.channels; ++c) sum += arrays::SumOfSquares(residual(c), padded_);
    *sum_robust_weight += static_cast<double>(count_);
  }
  for (std::size_t i = 0; model_.loss != Loss::kNone && i < count_; ++i) {
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
  reading_.FinishSlopes(padded_, f_.data(), slope_.data());
  return sum;
}

const double* Block::Columns(std::size_t c) {
  const double* const outside = slope_.data() + c * kBlock;
  // By what lies below a coat.
  if (coat_) arrays::Multiply(outside, coat_->through(c), padded_, below_slope_.data());
  const double* const below = coat_ ? below_slope_.data() : outside;
  const auto slope_of = [&](std::size_t l) { return IsCoat(model_.lobes[l].kind.fresnel) ? outside : below; };
  double* to = columns_.data();
  for (std::size_t l = 0; l < model_.lobes.size(); ++l)
    to = lobes_.WriteShape(l, c, slope_of(l), diffuse_.FacetsOf(l, c), padded_, to);
  for (std::size_t k = 0; differences_ != nullptr && k < differences_->size(); ++k, to += kBlock)
    arrays::Multiply(outside, differences_->column(k, c), padded_, to);
  for (std::size_t l = 0; l < model_.lobes.size(); ++l) {
    for (std::size_t k = 0; k < FresnelParameters(model_.lobes[l].kind.fresnel); ++k, to += kBlock) {
      lobes_.WriteFresnel(l, k, c, slope_of(l), padded_, to);
      if (IsCoat(model_.lobes[l].kind.fresnel)) arrays::AddFactor(outside, 0, 1, coat_->gradient(c, k), padded_, to);
    }
  }
  to = diffuse_.Write(c, below, padded_, to);
  to = reading_.Write(c, outside, padded_, to);
  std::copy_n(residual(c), padded_, to);
  return columns_.data();
}

const double* Block::SqrtWeight(std::size_t begin) {
  if (!HasWeights(samples_) && padded_ == count_) return nullptr;
  const double* cos_o = nullptr;
  if (samples_.sin_o) cos_o = PaddedArray(samples_.direction[5] + begin, count_, padded_, 0.0, &cos_o_pad_);
  WriteWeightRoots(samples_, begin, count_, padded_, cos_i_, cos_o, sqrt_weight_);
  return sqrt_weight_.data();
}

}  // namespace lobefit
