#include "lobefit/fit/sel/slice.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "lobefit/fit/sel/objective.h"

namespace lobefit {

std::size_t SelFreeParameters(std::size_t lobes, std::size_t channels) {
  return static_cast<std::size_t>(SelObjective::kShape) * lobes + (lobes + 1) * channels;
}

SelSliceFit FitSelSlice(const SelSamples& samples, const SelSlice& start, const SelSliceOptions& options,
                        const std::vector<SelPull>& pulls) {
  const SelObjective objective(samples, start.lobes.size(), options, pulls);
  SelObjective::Coordinates u = objective.From(start);
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  SelSliceFit fit;
  fit.sum_squares = objective.SumSquares(u, &hessian, &gradient);
  fit.objective = fit.sum_squares + objective.Pulls(u, &hessian, &gradient);
  double damping = 1e-3;
  // Marquardt's scaling, with a floor for coordinates that nothing depends on.
  while (fit.iterations < options.max_iterations && !fit.converged && damping < 1e12) {
    ++fit.iterations;
    Eigen::MatrixXd damped = hessian;
    Eigen::VectorXd slope = gradient;
    objective.Hold(u, &damped, &slope);
    const double floor = 1e-12 * std::max(hessian.diagonal().maxCoeff(), 1e-300);
    damped.diagonal() += damping * damped.diagonal().cwiseMax(floor).eval();
    damped.diagonal().array() += floor;
    const SelObjective::Coordinates next = objective.Clamped(u - damped.ldlt().solve(slope));
    const double sum_squares = objective.SumSquares(next, nullptr, nullptr);
    const double value = sum_squares + objective.Pulls(next, nullptr, nullptr);
    if (!(value <= fit.objective)) {
      // A rejected step of no length: this is the minimum to rounding.
      if ((next - u).norm() <= 1e-10 * (1 + u.norm())) fit.converged = true;
      damping *= 8;
      continue;
    }
    fit.converged = fit.objective - value <= 1e-7 * fit.objective;
    u = next;
    damping = std::max(damping / 5, 1e-12);
    fit.sum_squares = objective.SumSquares(u, &hessian, &gradient);
    fit.objective = fit.sum_squares + objective.Pulls(u, &hessian, &gradient);
  }
  fit.at_limit = objective.IsAtLimit(u);
  fit.slice = objective.ToSlice(u);
  fit.slice.theta_i = start.theta_i;
  fit.slice.phi_i = start.phi_i;
  return fit;
}

}  // namespace lobefit
