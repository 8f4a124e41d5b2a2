// One descent of a model on the samples of a problem.
#pragma once

#include <string>
#include <vector>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/gains.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/descent.h"

namespace lobefit {

inline constexpr std::size_t kManyCoordinates = 64;

struct SolveOptions {
  int max_iterations = 300;
  // Relative decrease of the cost at which a descent ends.
  double function_tolerance = 1e-12;
  bool use_ceres = true;  // DescentOptions::use_ceres
  // From so many coordinates on descents of what is an arrow go through it: a dense step takes their cube.
  std::size_t arrow_from = kManyCoordinates;
  bool along_kinks = false;  // DescentOptions::along_kinks
};

struct Solution {
  std::vector<double> u;   // solver coordinates
  double cost = 0;         // half the sum of rho at u; infinite where the start had none
  bool converged = false;  // u is a minimum within the bounds (IsMinimum)
  int iterations = 0;
  std::string message;
};

// Descends from `start` (within the bounds) by Levenberg-Marquardt. Gains are left at those of the solution. A start
// whose cost is not finite comes back not converged.
Solution Solve(const Problem& problem, const Layout& layout, const std::vector<double>& start,
               const SolveOptions& options, ThreadPool* pool);

// The same by a subsample's problem, `part`, that stands in for most passes (stand_in.h); without gains.
// options.max_iterations is the number of passes over the whole.
Solution SolveByStandIn(const Problem& problem, const Problem& part, const Layout& layout,
                        const std::vector<double>& start, const SolveOptions& options, ThreadPool* pool);

// Gauss-Newton matrix and gradient of the cost at `u`, and the cost. With gains (Problem::gains), at those that it has:
// of what the cost is where they follow the model (gains.h), with `links` unless null.
double Linearise(const Problem& problem, const Layout& layout, const double* u, ThreadPool* pool,
                 Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient, std::vector<GainLink>* links = nullptr);

// The same as an arrow, without gains and energy rule, which couple the channels.
double Linearise(const Problem& problem, const Layout& layout, const double* u, ThreadPool* pool, ArrowMatrix* hessian,
                 Eigen::VectorXd* gradient);
// The same as an arrow for every problem: where gains couple the channels all is border, and an energy rule's part goes
// through a dense matrix.
double LineariseBlocks(const Problem& problem, const Layout& layout, const double* u, ThreadPool* pool,
                       ArrowMatrix* hessian, Eigen::VectorXd* gradient, std::vector<GainLink>* links = nullptr);
// The problem over the box of the layout's bounds; all arguments must outlive it.
BoundedObjective ObjectiveOf(const Problem& problem, const Layout& layout, ThreadPool* pool);

}  // namespace lobefit
