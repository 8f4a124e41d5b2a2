// Columns of what moves the directions or the discs: central differences of the surface's f_r by the angles of the
// alignment and by the half angles of the discs. Internal to the kernel.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "lobefit/fit/kernel/block_arrays.h"
#include "lobefit/fit/kernel/kernel.h"

namespace lobefit {

class AngleDifferences {
 public:
  // Samples and model must outlive it.
  AngleDifferences(const KernelSamples& samples, const KernelModel& model);
  ~AngleDifferences();

  std::size_t size() const { return model_.alignment.angles.size() + model_.half_angles.size(); }
  // d f_r / d angle k in channel c.
  const double* column(std::size_t k, std::size_t c) const {
    return columns_.data() + (k * model_.channels + c) * kBlock;
  }

  // Of samples [begin, begin + count), count <= kBlock.
  void Evaluate(std::size_t begin, std::size_t count);

 private:
  struct Probe;  // a block of the surface alone, its model moved

  void Move(const std::vector<double>& angles, std::size_t begin, std::size_t count);
  // The first of a column's two values sets it. Pads are 0, as of the values.
  void Add(std::size_t k, const Probe& probe, double factor, std::size_t count);

  const KernelSamples& samples_;
  const KernelModel& model_;
  std::vector<double> columns_, moved_;
  KernelSamples moved_samples_ = {};
  std::unique_ptr<Probe> surface_;
  std::vector<std::unique_ptr<Probe>> discs_;  // above and below of each
};

}  // namespace lobefit
