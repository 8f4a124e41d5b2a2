// What readings that are wrong do to a fit with a loss, which holds them off and does not cut them out.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/errors/uncertainty.h"
#include "lobefit/fit/metric/metric.h"
#include "lobefit/fit/objective/problem.h"

namespace lobefit {

struct OutlierPull {
  std::size_t outliers = 0;  // samples further from the model than 5 standard deviations of the noise
  // What those above the model move a reported parameter by, and those below it, in its standard errors, for the one
  // that both together move most.
  double above = 0, below = 0;
  std::string parameter;
  double errors() const { return std::fabs(above) + std::fabs(below); }
};

// To first order a sample moves the solver's coordinates by -A^-1 rho' J^T r (Bread has A). Intervals hold where
// outliers pull upwards and downwards alike in the mean. One fit cannot tell: of n of them the two sides differ by
// chance as the root of n, and by n times their asymmetry, and where they pull most they are most of the standard
// error. So what is told is how much there is that may be uneven.
//
// `noise` is that of the readings, without the outliers (EstimateNoise). Nothing without a loss or without outliers.
std::optional<OutlierPull> PullOfOutliers(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                                          const Uncertainty& uncertainty, const NoiseModel& noise, ThreadPool* pool);

// In words that say what helps. Empty where even a quarter of the pull, left over, would bias no parameter by more than
// half a standard error.
std::string ToPullRemark(const OutlierPull& pull, Loss loss, double scale);
// Whether a remark is one of ToPullRemark.
bool IsPullRemark(const std::string& remark);

}  // namespace lobefit
