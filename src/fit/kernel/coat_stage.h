// What the coat of a model makes of the lobes and the diffuse part below it, block by block. Internal to the kernel.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/core/brdf/diffuse.h"
#include "lobefit/fit/kernel/kernel.h"

namespace lobefit {

// The lobe that is a coat; none: model.lobes.size().
std::size_t CoatOf(const KernelModel& model);

// f = lobe + clear exp(-tau path) f_below (coat.h), with the derivatives of the second part by the coat's ior and tau.
// The index is common to the channels, so that directions and `clear` are evaluated once.
class CoatStage {
 public:
  CoatStage(const KernelModel& model, std::size_t coat, bool gradient);

  // Directions below the coat of at most kBlock samples; valid until the next call. Evaluates the factors.
  DirectionArrays Enter(const DirectionArrays& outside);
  // f_r of a Lambertian part of albedo 1, as seen below the coat, 1/sr.
  double lambert() const { return lambert_; }
  // From f_r below the coat in channel c, of albedo a Lambertian part, to what leaves of it; `padded` values, pads 0.
  void Cover(std::size_t c, std::size_t padded, double* f);
  // Of the last Cover of a channel: what f_r below was multiplied by, and the derivatives by ior (0) and tau (1).
  const double* through(std::size_t c) const { return arrays_.data() + Place(c, 0); }
  const double* gradient(std::size_t c, std::size_t k) const { return arrays_.data() + Place(c, k + 1); }

 private:
  std::size_t Place(std::size_t c, std::size_t k) const;
  double Tau(std::size_t c) const;
  // Central differences by the index of the lobes below, whose directions move with it.
  void DifferenceIndex(const DirectionArrays& outside);

  const KernelModel& model_;
  std::size_t coat_, count_ = 0;
  double ior_, lambert_, dlambert_dior_ = 0;
  bool refracted_, gradient_;
  DirectionalDiffuse interface_;  // of the coat's index
  KernelModel below_;             // its lobes alone
  std::vector<double> arrays_;    // of each channel: through, and its gradient
  std::vector<double> clear_, path_, dlog_clear_, dpath_, inside_[6];
  std::vector<std::vector<double>> by_ior_;  // [channel] of f_r of the lobes below
};

}  // namespace lobefit
