// Standard errors of what is reported, and what the data do not determine.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/errors/entry_covariance.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {

// Covariances of the reported entries (Layout::Report, flattened; inside units): sandwiches A^-1 B A^-1 with A the
// second derivatives of the cost to second order in the loss (bread.h) and B from the gradients of samples or of
// incidences, set right for how far the fit bends towards each (sandwich.h), whatever their number.
//
// Rows and columns are NaN for an entry that has a part in an undetermined direction, or that is not differentiable
// (the angles of equal alphas); 0 for what is fixed or held at a bound.
struct Uncertainty {
  // Samples taken as independent, of noise that may differ from sample to sample. 95 % within the quantile of Student's
  // t with `independent_freedom` degrees of freedom (freedom.h), which the scatter of a few gains lessens where it
  // was estimated.
  EntryCovariance covariance;
  std::vector<double> independent_freedom;  // [entry]
  // Samples of one incident direction may depend on each other. 95 % within the quantile of Student's t with `freedom`
  // degrees of freedom. Of no entries with fewer than two incidences.
  EntryCovariance clustered;
  bool has_clusters = false;
  std::vector<double> freedom;  // [entry]; NaN where there is no error
  // As `covariance` of the solver's coordinates, 0 for what is held, without the undetermined directions; and of the
  // logarithms of gains what the coordinates give each.
  Eigen::VectorXd coordinate_variance, gain_variance;
  std::vector<bool> at_bound;           // [coordinate] held: the cost would go on falling beyond the bound
  std::vector<bool> undetermined;       // [entry]
  std::vector<std::string> degenerate;  // the undetermined directions, in words

  bool determined() const { return degenerate.empty(); }
};

// `most_full`: of more coordinates not all covariances are kept (EntryCovariance).
Uncertainty EstimateUncertainty(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                                const Incidences& incidences, ThreadPool* pool, std::size_t most_full = kMostFull);

}  // namespace lobefit
