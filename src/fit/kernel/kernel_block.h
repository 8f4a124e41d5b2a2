// One block of samples in the fit's inner loop: what kernel.cc streams. Its stages are files of their own: lobes with
// their Fresnel factors, the diffuse part, the coat over both, what the instrument reads. Internal to the kernel.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lobefit/fit/kernel/block_arrays.h"
#include "lobefit/fit/kernel/coat_stage.h"
#include "lobefit/fit/kernel/diffuse_stage.h"
#include "lobefit/fit/kernel/kernel.h"
#include "lobefit/fit/kernel/lobe_stage.h"
#include "lobefit/fit/kernel/reading_stage.h"

namespace lobefit {

class AngleDifferences;

// The model's values, residuals and columns. Arrays of kBlock, padded so that pads add nothing to any sum. Samples and
// model must outlive it.
class Block {
 public:
  // `slopes`: the derivatives by the gains, which need none of the model's; `gradient` includes them.
  Block(const KernelSamples& samples, const KernelModel& model, bool gradient, bool slopes = false);
  ~Block();
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;

  // Values of samples [begin, begin + count), count <= kBlock.
  void Evaluate(std::size_t begin, std::size_t count);
  // Residuals (and slopes) of what was evaluated, reweighted by the loss. Returns the sum of rho.
  double Residuals(std::size_t begin, double* sum_robust_weight);
  // Columns of one channel, kBlock apart, as KernelModel::columns has them; the last is the residual.
  const double* Columns(std::size_t c);

  std::size_t padded() const { return padded_; }
  const double* f(std::size_t c) const { return f_.data() + c * kBlock; }
  const double* residual(std::size_t c) const { return residual_.data() + c * kBlock; }
  const ReadingStage& reading() const { return reading_; }

 private:
  // Square roots of the weights of this block, 0 for pads; null where all are 1.
  const double* SqrtWeight(std::size_t begin);

  const KernelSamples& samples_;
  const KernelModel& model_;
  const bool slopes_;
  std::size_t count_ = 0, padded_ = 0;
  const double* cos_i_ = nullptr;
  std::optional<CoatStage> coat_;
  BlockArrays memory_;
  LobeStage lobes_;
  DiffuseStage diffuse_;
  ReadingStage reading_;
  std::unique_ptr<AngleDifferences> differences_;  // null: neither alignment nor discs are fitted
  std::span<double> f_, residual_, slope_, columns_, sqrt_weight_, below_slope_;
  std::span<double> moved_;  // directions in the sample's frame, where it stands crooked
  std::vector<double> cos_i_pad_, cos_o_pad_, measured_pad_;
};

}  // namespace lobefit
