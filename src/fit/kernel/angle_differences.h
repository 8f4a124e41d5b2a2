// Columns of what moves the directions or the discs: central differences of the surface's f_r by the angles of the
// alignment and by the half angles of the discs. Internal to the kernel.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "lobefit/fit/kernel/kernel.h"
#include "lobefit/fit/kernel/turned_axes.h"

namespace lobefit {

template <class Block>
class AngleDifferences {
 public:
  // `stride`: of the arrays, at least a block's samples.
  AngleDifferences(const KernelSamples& samples, const KernelModel& model, std::size_t stride)
      : samples_(samples), model_(model), stride_(stride), columns_(size() * model.channels * stride) {
    const bool moves = !model.alignment.angles.empty();
    if (moves) {
      moved_.resize(6 * stride);
      for (std::size_t k = 0; k < 6; ++k) moved_samples_.direction[k] = moved_.data() + k * stride;
      moved_samples_.count = stride;
      surface_ = std::make_unique<Probe>(moved_samples_, model, nullptr);
    }
    for (const KernelHalfAngle& half_angle : model.half_angles) {
      for (const auto* means : {&half_angle.above, &half_angle.below})
        discs_.push_back(std::make_unique<Probe>(moves ? moved_samples_ : samples, model, means));
    }
  }

  std::size_t size() const { return model_.alignment.angles.size() + model_.half_angles.size(); }
  // d f_r / d angle k in channel c.
  const double* column(std::size_t k, std::size_t c) const {
    return columns_.data() + (k * model_.channels + c) * stride_;
  }

  // Of samples [begin, begin + count).
  void Evaluate(std::size_t begin, std::size_t count) {
    // Of a lobe 0.01 wide off by 1e-8 of the derivative; rounding adds 1e-10.
    constexpr double kStep = 2e-6;
    std::vector<double> angles = model_.alignment.angles;
    for (std::size_t k = 0; k < angles.size(); ++k) {
      const double at = angles[k];
      for (const double sign : {1.0, -1.0}) {
        angles[k] = at + sign * kStep;
        Move(angles, begin, count);
        surface_->block.Evaluate(0, count);
        Add(k, surface_->block, sign / (2 * kStep), count);
      }
      angles[k] = at;
    }
    if (surface_ != nullptr && !discs_.empty()) Move(angles, begin, count);
    for (std::size_t d = 0; d < discs_.size(); ++d) {
      Block& block = discs_[d]->block;
      block.Evaluate(surface_ != nullptr ? 0 : begin, count);
      Add(angles.size() + d / 2, block, (d % 2 == 0 ? 0.5 : -0.5) / model_.half_angles[d / 2].step, count);
    }
  }

 private:
  // The surface's f_r under `means`, one a lobe; null: its own.
  struct Probe {
    KernelModel model;
    Block block;
    Probe(const KernelSamples& samples, const KernelModel& from,
          const std::vector<std::shared_ptr<const LobeMeanRule>>* means)
        : model(SurfaceOf(from, means)), block(samples, model, false) {}
  };
  static KernelModel SurfaceOf(KernelModel model, const std::vector<std::shared_ptr<const LobeMeanRule>>* means) {
    model.alignment = {};
    model.half_angles.clear();
    model.gains = false;
    model.offset.clear();
    for (std::size_t l = 0; means != nullptr && l < model.lobes.size(); ++l) model.lobes[l].mean = (*means)[l];
    return model;
  }

  void Move(const std::vector<double>& angles, std::size_t begin, std::size_t count) {
    TurnDirections(TurnsOf(model_.alignment.azimuths, angles), samples_.direction, samples_.turn, begin, count, stride_,
                   moved_.data());
  }
  // The first of a column's two values sets it. Pads are 0, as of the values.
  void Add(std::size_t k, const Block& block, double factor, std::size_t count) {
    for (std::size_t c = 0; c < model_.channels; ++c) {
      double* to = columns_.data() + (k * model_.channels + c) * stride_;
      for (std::size_t i = 0; i < count; ++i)
        to[i] = factor > 0 ? factor * block.f(c)[i] : to[i] + factor * block.f(c)[i];
      for (std::size_t i = count; i < block.padded(); ++i) to[i] = 0;
    }
  }

  const KernelSamples& samples_;
  const KernelModel& model_;
  const std::size_t stride_;
  std::vector<double> columns_, moved_;
  KernelSamples moved_samples_ = {};
  std::unique_ptr<Probe> surface_;
  std::vector<std::unique_ptr<Probe>> discs_;  // above and below of each
};

}  // namespace lobefit
