// The ABg lobes of a material as stray-light programs take them.
#pragma once

#include <string>
#include <vector>

#include "lobefit/material/material.h"

namespace lobefit {

// f_r = A / (B + |beta - beta_0|^g) of one lobe in one channel (core/brdf/abg_lobe.h), A in B's unit over sr.
struct AbgNumbers {
  std::size_t lobe = 0;
  std::string channel;
  double A = 0, B = 0, g = 0;
  // Standard errors to first order, as `stderr` of the document's parameters; NaN: not determined.
  double A_error = 0, B_error = 0, g_error = 0;
};

// Of the round ABg lobes, channel by channel; empty where there is none. An anisotropic lobe has no single B.
std::vector<AbgNumbers> AbgNumbersOf(const Material& material);

}  // namespace lobefit
