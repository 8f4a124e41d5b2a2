// An isotropic measurement as a function of any pair of directions.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lobefit/measurement/measurement.h"
#include "lobefit/report/figures/scatter.h"

namespace lobefit {

// Samples are averaged in cells of (sqrt(theta_h), theta_d, phi_d), with phi_d folded by reciprocity and mirror
// symmetry, and interpolated between the cells that hold any; nothing is known far from all of them.
class IsotropicLookup {
 public:
  explicit IsotropicLookup(const Measurement& measurement);

  // f_r a channel; false, and nothing written, where no sample is near.
  bool Find(const Vec3& wi, const Vec3& wo, double* f_r) const;

 private:
  // Between eight neighbouring cells, where all of them hold samples; a hundredth of the time that the tree takes.
  bool FindInFullCells(double h, double d, double phi, double* f_r) const;

  std::size_t channels_;
  std::vector<std::uint32_t> point_of_cell_;  // plus 1; 0: no sample
  std::vector<float> values_;                 // [point][channel]
  std::unique_ptr<ScatterTree> tree_;
};

}  // namespace lobefit
