#include "lobefit/fit/search/solve.h"

#include <cmath>
#include <mutex>

#include <ceres/ceres.h>
#include <glog/logging.h>

#include "lobefit/fit/search/symmetric_eigen.h"

namespace lobefit {
namespace {

std::vector<double> Clamped(const Layout& layout, const double* u) {
  std::vector<double> clamped(u, u + layout.size());
  for (std::size_t i = 0; i < clamped.size(); ++i) {
    clamped[i] = std::clamp(clamped[i], layout.coordinates()[i].low, layout.coordinates()[i].high);
  }
  return clamped;
}

// Second derivatives of the residuals, as far as the steps taken tell of them.
class Secant {
 public:
  // To be called with the Gauss-Newton matrix and gradient of each accepted point in turn; `sum` is twice the cost.
  void Update(const Eigen::VectorXd& u, const std::vector<bool>& held, double sum, const Eigen::MatrixXd& hessian,
              const Eigen::VectorXd& gradient) {
    // Far from the minimum the curvature changes from step to step.
    constexpr double kNear = 1e-2;
    near_ = held == held_ && u_.size() == u.size() && sum <= sum_ && sum_ - sum < kNear * sum_;
    if (!near_) {
      correction_.setZero(u.size(), u.size());
    } else {
      const Eigen::VectorXd scale = hessian.diagonal().cwiseSqrt();
      const Eigen::VectorXd step = u - u_;
      const Eigen::VectorXd missing = gradient - gradient_ - 0.5 * (hessian + hessian_) * step - correction_ * step;
      const double product = missing.dot(step);
      const Eigen::VectorXd scaled = missing.cwiseQuotient(scale.unaryExpr([](double x) { return x > 0 ? x : 1.0; }));
      if (std::fabs(product) > 1e-6 * scaled.norm() * step.cwiseProduct(scale).norm())
        correction_ += missing * missing.transpose() / product;
    }
    u_ = u;
    held_ = held;
    sum_ = sum;
    hessian_ = hessian;
    gradient_ = gradient;
  }

  // The matrix with the correction, but in no direction less than this share of the matrix' own curvature: where the
  // cost bends down (a lobe that begins to split), steps are 30 times longer, and the trust region judges them.
  Eigen::MatrixXd Corrected(const Eigen::MatrixXd& hessian) const {
    if (!near_) return hessian;
    constexpr double kLeastShare = 0.03, kUndetermined = 1e-10;
    const Eigen::VectorXd scale = hessian.diagonal().cwiseSqrt();
    const Eigen::VectorXd inverse = scale.unaryExpr([](double x) { return x > 0 ? 1 / x : 0.0; });
    const Eigen::MatrixXd scaled = inverse.asDiagonal() * hessian * inverse.asDiagonal();
    const SymmetricEigen eigen =
        DecomposeSymmetric(scaled + Eigen::MatrixXd(inverse.asDiagonal() * correction_ * inverse.asDiagonal()));
    const Eigen::MatrixXd& vectors = eigen.vectors;
    Eigen::VectorXd curvature = eigen.values;
    for (Eigen::Index i = 0; i < curvature.size(); ++i) {
      const double own = vectors.col(i).dot(scaled * vectors.col(i));
      curvature(i) = own < kUndetermined ? own : std::max(curvature(i), kLeastShare * own);
    }
    const Eigen::MatrixXd half = scale.asDiagonal() * vectors;
    return half * curvature.asDiagonal() * half.transpose();
  }

 private:
  Eigen::VectorXd u_, gradient_;
  Eigen::MatrixXd hessian_, correction_;
  std::vector<bool> held_;
  double sum_ = 0;
  bool near_ = false;
};

// All samples as n + 1 residuals (c, sqrt(|r|^2 - |c|^2)) with Jacobian (R; 0), where R^T R = J^T J and R^T c = J^T r:
// the same cost, the same Gauss-Newton matrix and the same gradient as the Jacobian of all samples, so the solver takes
// the same steps. R is sqrt(Lambda) V^T of the eigen-decomposition of J^T J scaled to a unit diagonal; unlike a
// Cholesky factor it exists for a singular matrix too, and keeps directions that the data do not determine at exactly
// zero.
//
// Where residuals stay large the Gauss-Newton matrix alone converges slowly: on a full table whose error is 3 %, each
// step leaves 65 % of the gradient. Close to the minimum a secant estimate of what it leaves out, the sum of r
// nabla^2 r, is added (symmetric rank one, from the change of the gradient), as in [Dennis, Gay, Welsch 1981]: the same
// descents end in a third of the steps.
//
// Bounds. The model is evaluated at the nearest point within them, and a coordinate beyond its bound has a zero column:
// the descent goes on in the others at full speed. Ceres' own bounds add a line search to every iteration: 61
// iterations and 1.5 s on a full table with one albedo at zero.
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
    const std::vector<double> u = Clamped(layout_, parameters[0]);
    Eigen::Map<Eigen::VectorXd> r(residuals, n + 1);
    // Ceres asks for the cost of a step first and, where it takes the step, which is most of the time, for the Jacobian
    // there. One pass over the samples serves both.
    if (last_.u != u) {
      last_.u = u;
      last_.sum = 2 * Linearise(problem_, layout_, u.data(), pool_, &last_.hessian, &last_.gradient);
    }
    const double sum = last_.sum;
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      r.setZero();
      r(n) = std::sqrt(sum);
      return std::isfinite(sum);
    }
    Eigen::MatrixXd hessian = last_.hessian;
    Eigen::VectorXd gradient = last_.gradient;
    if (!std::isfinite(sum) || !hessian.allFinite() || !gradient.allFinite()) return false;
    std::vector<bool> held(u.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      held[k] = parameters[0][i] != u[k];
      if (!held[k]) continue;
      hessian.row(i).setZero();
      hessian.col(i).setZero();
      gradient(i) = 0;
    }
    secant_.Update(Eigen::Map<const Eigen::VectorXd>(u.data(), n), held, sum, hessian, gradient);
    hessian = secant_.Corrected(hessian);
    const Eigen::VectorXd scale = hessian.diagonal().cwiseSqrt().unaryExpr([](double x) { return x > 0 ? x : 1.0; });
    const Eigen::VectorXd inverse = scale.cwiseInverse();
    const SymmetricEigen eigen = DecomposeSymmetric(inverse.asDiagonal() * hessian * inverse.asDiagonal());
    const Eigen::VectorXd root = eigen.values.cwiseMax(0.0).cwiseSqrt();
    const double floor = std::numeric_limits<double>::epsilon() * static_cast<double>(n) * root.maxCoeff();
    Eigen::VectorXd c = eigen.vectors.transpose() * (inverse.asDiagonal() * gradient);
    for (Eigen::Index i = 0; i < n; ++i) c(i) = root(i) > floor ? c(i) / root(i) : 0.0;
    r.head(n) = c;
    r(n) = std::sqrt(std::max(0.0, sum - c.squaredNorm()));
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> j(jacobians[0], n + 1, n);
    j.setZero();
    j.topRows(n) = root.asDiagonal() * eigen.vectors.transpose() * scale.asDiagonal();
    return true;
  }

 private:
  const Problem& problem_;
  const Layout& layout_;
  ThreadPool* pool_;
  // What the evaluations so far tell; Ceres evaluates one after the other.
  mutable Secant secant_;
  struct Evaluation {
    std::vector<double> u;
    double sum = 0;
    Eigen::MatrixXd hessian;
    Eigen::VectorXd gradient;
  };
  mutable Evaluation last_;
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

namespace {

// True where the cost falls from a bound inwards: the coordinate was held there too early.
bool WantsInside(const Problem& problem, const Layout& layout, const std::vector<double>& u, ThreadPool* pool) {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  bool any_at_bound = false;
  for (std::size_t i = 0; i < u.size(); ++i)
    any_at_bound = any_at_bound || u[i] == layout.coordinates()[i].low || u[i] == layout.coordinates()[i].high;
  if (!any_at_bound) return false;
  const double cost = Linearise(problem, layout, u.data(), pool, &hessian, &gradient);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    // A gradient J^T r smaller than 1e-9 |J_k| |r| is rounding.
    const double noise = 1e-9 * std::sqrt(hessian(k, k) * 2 * cost);
    if (u[i] == layout.coordinates()[i].low && gradient(k) < -noise) return true;
    if (u[i] == layout.coordinates()[i].high && gradient(k) > noise) return true;
  }
  return false;
}

}  // namespace

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
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.logging_type = ceres::SILENT;
  solver.function_tolerance = options.function_tolerance;
  solver.parameter_tolerance = 1e-13;
  solver.gradient_tolerance = 1e-16;
  solver.num_threads = 1;
  // A descent may leave a coordinate at a bound that it would rather leave again: then it goes on from there.
  constexpr int kMaxRounds = 8;
  for (int round = 0; round < kMaxRounds; ++round) {
    solver.max_num_iterations = options.max_iterations - solution.iterations;
    if (solver.max_num_iterations <= 0) break;
    const double before = solution.cost;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &ceres_problem, &summary);
    // In place: the problem keeps the address.
    const std::vector<double> clamped = Clamped(layout, solution.u.data());
    std::copy(clamped.begin(), clamped.end(), solution.u.begin());
    solution.cost = summary.final_cost;
    solution.converged = summary.termination_type == ceres::CONVERGENCE;
    solution.iterations += static_cast<int>(summary.iterations.size());
    solution.message = summary.message;
    if (!solution.converged || !WantsInside(problem, layout, solution.u, pool)) break;
    // Where the model vanishes the cube root has no derivative, and going on from the bound gains nothing.
    if (round > 0 && before - solution.cost <= 1e-8 * before) break;
    solution.converged = false;
  }
  return solution;
}

}  // namespace lobefit
