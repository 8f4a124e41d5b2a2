// One descent with Ceres: a single residual block of constant size stands for all samples.
#pragma once

#include <string>
#include <vector>

#include "lobefit/fit/objective/coordinates.h"
#include "lobefit/fit/objective/problem.h"

namespace lobefit {

struct SolveOptions {
  int max_iterations = 300;
  // Relative decrease of the cost at which a descent ends.
  double function_tolerance = 1e-12;
};

struct Solution {
  std::vector<double> u;  // solver coordinates
  double cost = 0;        // half the sum of rho
  bool converged = false;
  int iterations = 0;
  std::string message;
};

// Descends from `start` (within the bounds) by Levenberg-Marquardt. A start whose cost is not finite comes back not
// converged.
Solution Solve(const Problem& problem, const Layout& layout, const std::vector<double>& start,
               const SolveOptions& options, ThreadPool* pool);

// Gauss-Newton matrix and gradient of the cost at `u`, and the cost.
double Linearise(const Problem& problem, const Layout& layout, const double* u, ThreadPool* pool,
                 Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient);

}  // namespace lobefit
