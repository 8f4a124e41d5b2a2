#include "lobefit/fit/solve.h"

#include <cmath>
#include <mutex>

#include <Eigen/Eigenvalues>
#include <ceres/ceres.h>
#include <glog/logging.h>

namespace lobefit {
namespace {

// All samples as n + 1 residuals (c, sqrt(|r|^2 - |c|^2)) with Jacobian (R; 0), where R^T R = J^T J and R^T c = J^T r:
// the same cost, the same Gauss-Newton matrix and the same gradient as the Jacobian of all samples, so the solver takes
// the same steps. R is sqrt(Lambda) V^T of the eigen-decomposition of J^T J scaled to a unit diagonal; unlike a
// Cholesky factor it exists for a singular matrix too, and keeps directions that the data do not determine at exactly
// zero.
class StreamedCost : public ceres::CostFunction {
 public:
  StreamedCost(const Problem& problem, const Layout& layout, ThreadPool* pool)
      : problem_(problem), layout_(layout), pool_(pool) {
    const int n = static_cast<int>(layout.size());
    mutable_parameter_block_sizes()->push_back(n);
    set_num_residuals(n + 1);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const auto n = static_cast<Eigen::Index>(layout_.size());
    Eigen::Map<Eigen::VectorXd> r(residuals, n + 1);
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      const double sum = problem_.Sum(layout_.ToKernel(parameters[0]), false, pool_).sum_rho;
      r.setZero();
      r(n) = std::sqrt(sum);
      return std::isfinite(sum);
    }
    Eigen::MatrixXd hessian;
    Eigen::VectorXd gradient;
    const double sum = 2 * Linearise(problem_, layout_, parameters[0], pool_, &hessian, &gradient);
    if (!std::isfinite(sum) || !hessian.allFinite() || !gradient.allFinite()) return false;
    const Eigen::VectorXd scale = hessian.diagonal().cwiseSqrt().unaryExpr([](double x) { return x > 0 ? x : 1.0; });
    const Eigen::VectorXd inverse = scale.cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(inverse.asDiagonal() * hessian * inverse.asDiagonal());
    const Eigen::VectorXd root = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    const double floor = std::numeric_limits<double>::epsilon() * static_cast<double>(n) * root.maxCoeff();
    Eigen::VectorXd c = eigen.eigenvectors().transpose() * (inverse.asDiagonal() * gradient);
    for (Eigen::Index i = 0; i < n; ++i) c(i) = root(i) > floor ? c(i) / root(i) : 0.0;
    r.head(n) = c;
    r(n) = std::sqrt(std::max(0.0, sum - c.squaredNorm()));
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> j(jacobians[0], n + 1, n);
    j.setZero();
    j.topRows(n) = root.asDiagonal() * eigen.eigenvectors().transpose() * scale.asDiagonal();
    return true;
  }

 private:
  const Problem& problem_;
  const Layout& layout_;
  ThreadPool* pool_;
};

// Ceres prints failed evaluations to stderr even with SILENT logging.
void SilenceLogging() {
  static std::once_flag once;
  std::call_once(once, [] { FLAGS_minloglevel = google::GLOG_FATAL; });
}

}  // namespace

double Linearise(const Problem& problem, const Layout& layout, const double* u, ThreadPool* pool,
                 Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) {
  const KernelSums sums = problem.Sum(layout.ToKernel(u), true, pool);
  layout.Gather(sums, hessian, gradient);
  return sums.sum_rho / 2;
}

Solution Solve(const Problem& problem, const Layout& layout, const std::vector<double>& start,
               const SolveOptions& options, ThreadPool* pool) {
  SilenceLogging();
  Solution solution;
  solution.u = start;
  ceres::Problem::Options problem_options;
  problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  StreamedCost cost(problem, layout, pool);
  ceres::Problem ceres_problem(problem_options);
  ceres_problem.AddResidualBlock(&cost, nullptr, solution.u.data());
  for (std::size_t i = 0; i < layout.size(); ++i) {
    ceres_problem.SetParameterLowerBound(solution.u.data(), static_cast<int>(i), layout.coordinates()[i].low);
    ceres_problem.SetParameterUpperBound(solution.u.data(), static_cast<int>(i), layout.coordinates()[i].high);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.logging_type = ceres::SILENT;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.function_tolerance;
  solver.parameter_tolerance = 1e-13;
  solver.gradient_tolerance = 1e-16;
  solver.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &ceres_problem, &summary);
  solution.cost = summary.final_cost;
  solution.converged = summary.termination_type == ceres::CONVERGENCE;
  solution.iterations = static_cast<int>(summary.iterations.size());
  solution.message = summary.message;
  return solution;
}

}  // namespace lobefit
