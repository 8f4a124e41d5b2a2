#include "lobefit/fit/sel/slice.h"

#include "lobefit/fit/search/descent.h"
#include "lobefit/fit/search/solve.h"
#include "lobefit/fit/sel/objective.h"

namespace lobefit {

std::size_t SelFreeParameters(std::size_t lobes, std::size_t channels) {
  return static_cast<std::size_t>(SelObjective::kShape) * lobes + (lobes + 1) * channels;
}

SelSliceFit FitSelSlice(const SelSamples& samples, const SelSlice& start, const SelSliceOptions& options,
                        const std::vector<SelPull>& pulls) {
  const SelObjective objective(samples, start.lobes.size(), options, pulls);
  BoundedObjective bounded;
  bounded.low = objective.Low();
  bounded.high = objective.High();
  bounded.residuals = samples.size() * samples.channels();
  bounded.evaluate = [&](const Eigen::VectorXd& u, Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) {
    return (objective.SumSquares(u, hessian, gradient) + objective.Pulls(u, hessian, gradient)) / 2;
  };
  if (objective.size() >= static_cast<Eigen::Index>(kManyCoordinates)) {
    bounded.evaluate_arrow = [&](const Eigen::VectorXd& u, ArrowMatrix* hessian, Eigen::VectorXd* gradient) {
      return (objective.SumSquares(u, hessian, gradient) + objective.Pulls(u, &hessian->border, gradient)) / 2;
    };
  }
  DescentOptions descent_options;
  descent_options.max_iterations = options.max_iterations;
  descent_options.function_tolerance = 1e-7;
  descent_options.damping_floor = 1e-12;
  const Descent descent = Descend(bounded, objective.From(start), descent_options);
  SelSliceFit fit;
  fit.iterations = descent.iterations;
  fit.converged = descent.converged;
  fit.objective = 2 * descent.cost;
  fit.sum_squares = fit.objective - objective.Pulls(descent.u, nullptr, nullptr);
  fit.at_limit = objective.IsAtLimit(descent.u);
  fit.slice = objective.ToSlice(descent.u);
  fit.slice.theta_i = start.theta_i;
  fit.slice.phi_i = start.phi_i;
  return fit;
}

}  // namespace lobefit
