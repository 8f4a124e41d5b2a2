// Recovery without noise: how near a fit comes to the parameters that made the data, and what keeps it from them.
#pragma once

#include <string>
#include <vector>

#include "lobefit/validate/experiment.h"

namespace lobefit {

struct Recovery {
  std::size_t trials = 0;
  double limit = 1e-8;
  double median = 0, largest = 0;  // relative difference of lobes in slope space and of all else
  // Trials beyond the limit, worst first, with their reason in words.
  struct Exception {
    std::size_t trial = 0;
    double difference = 0;
    std::string reason;
  };
  std::vector<Exception> exceptions;
  // Exceptions of which the fit gave no sign: it converged to a residual above rounding and named nothing.
  std::size_t silent = 0;

  bool passed() const { return silent == 0 && trials > 0; }
};

Recovery JudgeRecovery(const Experiment& experiment, const std::vector<Trial>& trials, double limit = 1e-8);
std::string ToText(const Recovery& recovery, const Experiment& experiment, const std::vector<Trial>& trials);

}  // namespace lobefit
