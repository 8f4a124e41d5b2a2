// Samples made ready for the kernel under one recipe, and sums over them on several threads.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/kernel/kernel.h"
#include "lobefit/fit/objective/sigma_weights.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

class EnergyRule;
class Gains;

// Sets the samples aside that the recipe's metric cannot take: beyond the angle limit; values that the transform has no
// number for (log: 1 + f cos_theta_i <= 0; relative: f <= 0). Throws InputError where none is left.
void SetAsideForRecipe(const Recipe& recipe, Measurement* measurement);

// kAuto turned into what it means for these samples.
Weighting EffectiveWeighting(Weighting weighting, const Samples& samples);

// Keeps references to `samples`, which must outlive it.
class Problem {
 public:
  // `weighting` and metric from the recipe. Throws InputError where solid angles are wanted and the format has none.
  Problem(const Samples& samples, const Recipe& recipe);
  Problem(const Problem&) = delete;
  Problem& operator=(const Problem&) = delete;

  std::size_t size() const { return kernel_.count; }
  std::size_t channels() const { return kernel_.measured.size(); }
  const KernelSamples& kernel_samples() const { return kernel_; }
  // Of a sample's squared residual, mean 1.
  double Weight(std::size_t i) const;

  // Stated uncertainties weigh by the value that the model has, which is not known before the fit: until the first call
  // by the readings. Fits call this and descend again, until that changes nothing (iteratively reweighted least
  // squares); the derivatives of the cost hold the weights fixed. Does nothing where no uncertainty is stated.
  void Reweigh(const KernelModel& model, ThreadPool* pool);
  bool depends_on_model() const { return !sigma_.empty(); }

  // Readings are multiplied by `gains` from now on, which must outlive this; their prior is part of the cost.
  void AttachGains(Gains* gains);
  Gains* gains() const { return gains_; }
  // Its penalty is part of the cost of Solve and Linearise from now on; it must outlive this.
  void AttachEnergy(const EnergyRule* rule) { energy_ = rule; }
  const EnergyRule* energy() const { return energy_; }
  GainSums SumGains(const KernelModel& model, ThreadPool* pool) const;

  // Sums over all samples. The samples are cut into a fixed number of runs whose sums are added in order, so that the
  // result does not depend on the number of threads, and memory does not depend on the number of samples.
  KernelSums Sum(const KernelModel& model, bool gradient, ThreadPool* pool) const;

 private:
  void ScaleToMeanOne();

  const Samples& samples_;
  Metric metric_;
  KernelSamples kernel_;
  SigmaWeights sigma_;
  Gains* gains_ = nullptr;
  const EnergyRule* energy_ = nullptr;
  std::vector<std::uint16_t> turn_;  // of each sample, where an alignment is fitted over several
  std::vector<double> weight_;       // the samples' own times those of their uncertainties; empty where there are none
};

// Pointers to the samples' directions in the kernel's order.
void SetDirections(const Samples& samples, KernelSamples* kernel);

// Runs [begin, end) of samples in a fixed cut that depends on `count` only.
std::size_t RunCount(std::size_t count);
std::size_t RunBegin(std::size_t count, std::size_t run);

}  // namespace lobefit
