#include "lobefit/fit/kernel/angle_differences.h"

#include "lobefit/fit/kernel/kernel_block.h"
#include "lobefit/fit/kernel/turned_axes.h"

namespace lobefit {
namespace {

// The surface's f_r under `means`, one a lobe; null: its own.
KernelModel SurfaceOf(KernelModel model, const std::vector<std::shared_ptr<const LobeMeanRule>>* means) {
  model.alignment = {};
  model.half_angles.clear();
  model.gains = false;
  model.offset.clear();
  for (std::size_t l = 0; means != nullptr && l < model.lobes.size(); ++l) model.lobes[l].mean = (*means)[l];
  return model;
}

}  // namespace

struct AngleDifferences::Probe {
  KernelModel model;
  Block block;
  Probe(const KernelSamples& samples, const KernelModel& from,
        const std::vector<std::shared_ptr<const LobeMeanRule>>* means)
      : model(SurfaceOf(from, means)), block(samples, model, false) {}
};

AngleDifferences::AngleDifferences(const KernelSamples& samples, const KernelModel& model)
    : samples_(samples), model_(model), columns_(size() * model.channels * kBlock) {
  const bool moves = !model.alignment.angles.empty();
  if (moves) {
    moved_.resize(6 * kBlock);
    for (std::size_t k = 0; k < 6; ++k) moved_samples_.direction[k] = moved_.data() + k * kBlock;
    moved_samples_.count = kBlock;
    surface_ = std::make_unique<Probe>(moved_samples_, model, nullptr);
  }
  for (const KernelHalfAngle& half_angle : model.half_angles) {
    for (const auto* means : {&half_angle.above, &half_angle.below})
      discs_.push_back(std::make_unique<Probe>(moves ? moved_samples_ : samples, model, means));
  }
}

AngleDifferences::~AngleDifferences() = default;

void AngleDifferences::Evaluate(std::size_t begin, std::size_t count) {
  // Of a lobe 0.01 wide off by 1e-8 of the derivative; rounding adds 1e-10.
  constexpr double kStep = 2e-6;
  std::vector<double> angles = model_.alignment.angles;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const double at = angles[k];
    for (const double sign : {1.0, -1.0}) {
      angles[k] = at + sign * kStep;
      Move(angles, begin, count);
      surface_->block.Evaluate(0, count);
      Add(k, *surface_, sign / (2 * kStep), count);
    }
    angles[k] = at;
  }
  if (surface_ != nullptr && !discs_.empty()) Move(angles, begin, count);
  for (std::size_t d = 0; d < discs_.size(); ++d) {
    discs_[d]->block.Evaluate(surface_ != nullptr ? 0 : begin, count);
    Add(angles.size() + d / 2, *discs_[d], (d % 2 == 0 ? 0.5 : -0.5) / model_.half_angles[d / 2].step, count);
  }
}

void AngleDifferences::Move(const std::vector<double>& angles, std::size_t begin, std::size_t count) {
  TurnDirections(TurnsOf(model_.alignment.azimuths, angles), samples_.direction, samples_.turn, begin, count, kBlock,
                 moved_.data());
}

void AngleDifferences::Add(std::size_t k, const Probe& probe, double factor, std::size_t count) {
  for (std::size_t c = 0; c < model_.channels; ++c) {
    double* to = columns_.data() + (k * model_.channels + c) * kBlock;
    const double* f = probe.block.f(c);
    for (std::size_t i = 0; i < count; ++i) to[i] = factor > 0 ? factor * f[i] : to[i] + factor * f[i];
    for (std::size_t i = count; i < probe.block.padded(); ++i) to[i] = 0;
  }
}

}  // namespace lobefit
