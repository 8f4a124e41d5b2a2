// Samples of one incident direction, to which a slice of a table of lobes is fitted (sel_table.h).
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/core/sel/sel_table.h"

namespace lobefit {

struct SelSamples {
  std::vector<Vec3> v;  // wo in the mirror frame of the sample's own wi
  std::vector<double> cos_i, cos_o;
  std::vector<double> weight;            // of the squared residual
  std::vector<std::vector<double>> f_r;  // [channel][sample]

  std::size_t size() const { return v.size(); }
  std::size_t channels() const { return f_r.size(); }
  // g of a sample: f_r, or f_r cos_theta_o.
  double Value(SelQuantity quantity, std::size_t channel, std::size_t i) const {
    return quantity == SelQuantity::kBrdf ? f_r[channel][i] : f_r[channel][i] * cos_o[i];
  }
  SelSamples Subset(const std::vector<std::size_t>& indices) const;
  // These and their images in the plane of incidence.
  SelSamples WithMirrorImages() const;
  // One channel, the mean of all.
  SelSamples Mean() const;
};

}  // namespace lobefit
