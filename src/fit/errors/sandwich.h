// The filling of the sandwich covariance, from samples one by one and from clusters of them.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/errors/bread.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {

// Both in whitened coordinates (bread.h), m x m.
struct Filling {
  // Sum of a a^T over samples with a = (1 - curvature of the sample)^-1 times its gradient: what the solution moves by,
  // to first order, when the sample is left out [MacKinnon and White 1985, HC3; with a loss the one-step jackknife].
  // With the power -1/2 (HC2) alpha_x of a metal with few samples in its highlight was covered in 93.3 % instead of
  // 93.5 % of 1000 trials.
  Eigen::MatrixXd samples;
  Eigen::VectorXd samples_freedom;   // of `samples`, for each of the numbers: freedom.h
  Eigen::MatrixXd clusters;          // CR2 over incidences, clusters.h
  Eigen::VectorXd clusters_freedom;  // of `clusters`, likewise
};

// `numbers`: m x numbers, whose degrees of freedom are wanted. Samples are taken incidence by incidence, so that only
// one incidence's sums are held at a time: memory is bounded by 4 bytes a sample and by m^2, whatever the number of
// incidences. The result does not depend on the number of threads.
Filling FillSandwich(const Problem& problem, const Layout& layout, const std::vector<double>& u, const Bread& bread,
                     const Incidences& incidences, const Eigen::MatrixXd& numbers, ThreadPool* pool);

}  // namespace lobefit
