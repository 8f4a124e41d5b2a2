#include "lobefit/fit/search/solve.h"

#include "lobefit/fit/objective/energy_rule.h"
#include "lobefit/fit/search/descent.h"
#include "lobefit/fit/search/stand_in.h"

namespace lobefit {
namespace {

Eigen::VectorXd ToVector(const std::vector<double>& u) {
  return Eigen::Map<const Eigen::VectorXd>(u.data(), static_cast<Eigen::Index>(u.size()));
}

DescentOptions ToDescentOptions(const SolveOptions& options) {
  DescentOptions descent;
  descent.max_iterations = options.max_iterations;
  descent.function_tolerance = options.function_tolerance;
  descent.use_ceres = options.use_ceres;
  descent.along_kinks = options.along_kinks;
  return descent;
}

Solution ToSolution(const Descent& descent) {
  return {{descent.u.data(), descent.u.data() + descent.u.size()},
          descent.cost,
          descent.converged,
          descent.iterations,
          descent.message};
}

}  // namespace

double Linearise(const Problem& problem, const Layout& layout, const double* u, ThreadPool* pool,
                 Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient, std::vector<GainLink>* links) {
  const KernelSums sums = problem.Sum(layout.ToKernel(u), true, pool);
  layout.Gather(sums, hessian, gradient);
  if (problem.gains() != nullptr) EliminateGains(sums, layout, *problem.gains(), hessian, gradient, links);
  double cost = sums.sum_rho / 2;
  if (problem.energy() != nullptr) cost += problem.energy()->Add(layout, u, pool, hessian, gradient);
  return cost;
}

double Linearise(const Problem& problem, const Layout& layout, const double* u, ThreadPool* pool, ArrowMatrix* hessian,
                 Eigen::VectorXd* gradient) {
  const KernelSums sums = problem.Sum(layout.ToKernel(u), true, pool);
  layout.Gather(sums, hessian, gradient);
  return sums.sum_rho / 2;
}

double LineariseBlocks(const Problem& problem, const Layout& layout, const double* u, ThreadPool* pool,
                       ArrowMatrix* hessian, Eigen::VectorXd* gradient, std::vector<GainLink>* links) {
  if (problem.gains() == nullptr && problem.energy() == nullptr)
    return Linearise(problem, layout, u, pool, hessian, gradient);
  Eigen::MatrixXd dense;
  const double cost = Linearise(problem, layout, u, pool, &dense, gradient, links);
  *hessian = ArrowMatrix(problem.gains() != nullptr ? BorderOnly(layout) : ArrowShapeOf(layout));
  const ArrowShape& shape = hessian->shape;
  hessian->border = dense(shape.border, shape.border);
  for (std::size_t c = 0; c < shape.own.size(); ++c) {
    hessian->across[c] = dense(shape.border, shape.own[c]);
    hessian->own[c] = dense(shape.own[c], shape.own[c]);
  }
  return cost;
}

BoundedObjective ObjectiveOf(const Problem& problem, const Layout& layout, ThreadPool* pool) {
  const auto n = static_cast<Eigen::Index>(layout.size());
  BoundedObjective objective;
  objective.low.resize(n);
  objective.high.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    objective.low(i) = layout.coordinates()[static_cast<std::size_t>(i)].low;
    objective.high(i) = layout.coordinates()[static_cast<std::size_t>(i)].high;
  }
  objective.residuals = problem.size() * problem.channels();
  objective.evaluate = [&problem, &layout, pool](const Eigen::VectorXd& u, Eigen::MatrixXd* gram,
                                                 Eigen::VectorXd* gradient) {
    if (problem.gains() != nullptr) problem.gains()->Profile(problem, layout.ToKernel(u.data()), pool);
    if (gram != nullptr) return Linearise(problem, layout, u.data(), pool, gram, gradient);
    const double cost = problem.Sum(layout.ToKernel(u.data()), false, pool).sum_rho / 2;
    if (problem.energy() == nullptr) return cost;
    return cost + problem.energy()->Add(layout, u.data(), pool, nullptr, nullptr);
  };
  if (layout.size() >= kManyCoordinates && problem.gains() == nullptr && problem.energy() == nullptr) {
    objective.evaluate_arrow = [&problem, &layout, pool](const Eigen::VectorXd& u, ArrowMatrix* gram,
                                                         Eigen::VectorXd* gradient) {
      return Linearise(problem, layout, u.data(), pool, gram, gradient);
    };
  }
  return objective;
}

Solution Solve(const Problem& problem, const Layout& layout, const std::vector<double>& start,
               const SolveOptions& options, ThreadPool* pool) {
  BoundedObjective objective = ObjectiveOf(problem, layout, pool);
  if (layout.size() < options.arrow_from) objective.evaluate_arrow = nullptr;
  const Descent descent = Descend(objective, ToVector(start), ToDescentOptions(options));
  if (problem.gains() != nullptr) problem.gains()->Profile(problem, layout.ToKernel(descent.u.data()), pool);
  return ToSolution(descent);
}

Solution SolveByStandIn(const Problem& problem, const Problem& part, const Layout& layout,
                        const std::vector<double>& start, const SolveOptions& options, ThreadPool* pool) {
  const double scale = static_cast<double>(problem.size()) / static_cast<double>(part.size());
  return ToSolution(DescendByStandIn(ObjectiveOf(problem, layout, pool), ObjectiveOf(part, layout, pool), scale,
                                     ToVector(start), ToDescentOptions(options)));
}

}  // namespace lobefit
