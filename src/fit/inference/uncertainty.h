// Standard errors and what the data do not determine.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "lobefit/fit/objective/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {

// Covariances of the solver's coordinates: sandwiches H^-1 B H^-1 with H = J^T J and B = sum of s s^T. A fit bends
// towards what weighs much in it and leaves too small residuals there; they are set right by the leverages: HC3 for
// samples [MacKinnon and White 1985], CR2 for clusters [Bell and McCaffrey 2002]. In large problems, where no sample
// weighs much, the factors N / (N - p) and G / (G - 1) stand for them (HC1, CR1).
struct Uncertainty {
  // s = J^T r of one sample over its channels: valid where the noise differs from sample to sample, but samples are
  // independent. Errors are normal: 95 % within 1.96 standard errors.
  Eigen::MatrixXd covariance;
  // s = J^T r of one incident direction: samples of one incidence may depend on each other. Zero rows with fewer than
  // two incidences. Estimated from G incidences: 95 % within the quantile of Student's t with G - 1 degrees of freedom.
  Eigen::MatrixXd clustered;
  bool has_clusters = false;
  // Coordinates at a bound: held, variance 0.
  std::vector<bool> at_bound;
  // False where some direction in parameter space does not change the residuals (reciprocal condition below 1e-10).
  bool determined = true;
  std::vector<std::string> degenerate;  // those directions, in words
};

Uncertainty EstimateUncertainty(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                                const Incidences& incidences, ThreadPool* pool);

}  // namespace lobefit
