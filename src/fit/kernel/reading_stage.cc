#include "lobefit/fit/kernel/reading_stage.h"

#include <algorithm>

#include "lobefit/fit/kernel/kernel_arrays.h"

namespace lobefit {

ReadingStage::ReadingStage(const KernelSamples& samples, const KernelModel& model, bool gradient, bool slopes,
                           BlockArrays* memory)
    : samples_(samples), model_(model), gradient_(gradient), slopes_(slopes || gradient) {
  const bool offset = !model.offset.empty();
  memory->Want(&gain_, model.gains ? 1 : 0);
  memory->Want(&gain_column_, model.gains && slopes_ ? model.channels : 0);
  memory->Want(&inverse_cos_i_, offset ? 1 : 0);
  memory->Want(&slope_by_reading_, offset && gradient ? model.channels : 0);
}

void ReadingStage::Apply(std::size_t begin, std::size_t count, std::size_t padded, const double* cos_i, double* f) {
  begin_ = begin;
  count_ = count;
  if (model_.gains) {
    std::fill(gain_.begin(), gain_.end(), 1.0);
    for (std::size_t i = 0; samples_.gain != nullptr && i < count; ++i)
      gain_[i] = samples_.gain[samples_.gain_group[begin + i]];
    for (std::size_t c = 0; c < model_.channels; ++c)
      arrays::Multiply(gain_.data(), f + c * kBlock, padded, f + c * kBlock);
  }
  if (model_.offset.empty()) return;
  std::fill(inverse_cos_i_.begin(), inverse_cos_i_.end(), 0.0);
  for (std::size_t i = 0; i < count; ++i) inverse_cos_i_[i] = 1 / cos_i[i];
  for (std::size_t c = 0; c < model_.channels; ++c)
    arrays::AddScaled(inverse_cos_i_.data(), model_.offset[c], padded, f + c * kBlock);
}

void ReadingStage::FinishSlopes(std::size_t padded, const double* f, double* slope) {
  if (!model_.gains || !slopes_) return;
  for (std::size_t c = 0; c < model_.channels; ++c) {
    double *by_reading = slope + c * kBlock, *column = gain_column_.data() + c * kBlock;
    arrays::Multiply(by_reading, f + c * kBlock, padded, column);
    if (!model_.offset.empty()) {
      // An offset is not scaled by the gain.
      for (std::size_t i = 0; i < padded; ++i) column[i] -= by_reading[i] * model_.offset[c] * inverse_cos_i_[i];
      if (gradient_) std::copy_n(by_reading, padded, slope_by_reading_.data() + c * kBlock);
    }
    arrays::Multiply(gain_.data(), by_reading, padded, by_reading);
  }
}

double* ReadingStage::Write(std::size_t c, const double* slope, std::size_t padded, double* to) const {
  if (!model_.offset.empty()) {
    // By the reading, which a gain does not scale.
    const double* by_reading = model_.gains ? slope_by_reading_.data() + c * kBlock : slope;
    arrays::Multiply(by_reading, inverse_cos_i_.data(), padded, to);
    to += kBlock;
  }
  if (model_.gains) {
    std::copy_n(gain_column(c), padded, to);
    to += kBlock;
  }
  return to;
}

}  // namespace lobefit
