#include "lobefit/fit/uncertainty.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "lobefit/base/text.h"
#include "lobefit/fit/solve.h"

namespace lobefit {
namespace {

// Below this eigenvalue of the Gauss-Newton matrix, scaled to a unit diagonal, a direction is taken as not determined:
// its standard error is 1e5 times that of its coordinates alone.
constexpr double kUndetermined = 1e-10;

// Sums of scores over samples: sum s s^T, and sum s a cluster.
struct Meat {
  Eigen::MatrixXd samples;   // n x n
  Eigen::MatrixXd clusters;  // clusters x n
};

Meat SumScores(const Problem& problem, const Layout& layout, const std::vector<double>& u, const Incidences& incidences,
               ThreadPool* pool) {
  const KernelModel kernel = layout.ToKernel(u.data());
  const auto n = static_cast<Eigen::Index>(layout.size());
  const auto clusters = static_cast<Eigen::Index>(incidences.wi.size());
  const std::size_t runs = RunCount(problem.size());
  std::vector<Meat> partial(runs);
  pool->Run(runs, [&](std::size_t run) {
    Meat& meat = partial[run];
    meat.samples.setZero(n, n);
    meat.clusters.setZero(clusters, n);
    const std::size_t last = RunBegin(problem.size(), run + 1);
    constexpr std::size_t kPiece = 1024;
    std::vector<std::vector<double>> scores;
    Eigen::MatrixXd s;
    for (std::size_t begin = RunBegin(problem.size(), run); begin < last; begin += kPiece) {
      const std::size_t end = std::min(last, begin + kPiece);
      Scores(problem.kernel_samples(), kernel, begin, end, &scores);
      const std::vector<std::vector<double>> gathered = layout.GatherScores(scores);
      s.resize(static_cast<Eigen::Index>(end - begin), n);
      for (Eigen::Index j = 0; j < n; ++j) {
        std::copy(gathered[static_cast<std::size_t>(j)].begin(), gathered[static_cast<std::size_t>(j)].end(),
                  s.col(j).data());
      }
      meat.samples.noalias() += s.transpose() * s;
      for (std::size_t i = begin; i < end; ++i) {
        meat.clusters.row(incidences.group[i]) += s.row(static_cast<Eigen::Index>(i - begin));
      }
    }
  });
  for (std::size_t run = 1; run < runs; ++run) {
    partial[0].samples += partial[run].samples;
    partial[0].clusters += partial[run].clusters;
  }
  return partial[0];
}

// "ln alpha_x and f0[R]" for the coordinates that dominate a direction.
std::string NameDirection(const Eigen::VectorXd& direction, const std::vector<int>& index, const Layout& layout) {
  std::vector<std::string> names;
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    if (std::fabs(direction(i)) > 0.3)
      names.push_back(layout.coordinates()[static_cast<std::size_t>(index[static_cast<std::size_t>(i)])].name);
  }
  if (names.size() == 1) return names[0] + ": the samples do not depend on it";
  return Join(names, " and ") + ": only a combination of them changes what was measured";
}

}  // namespace

Uncertainty EstimateUncertainty(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                                const Incidences& incidences, ThreadPool* pool) {
  Uncertainty result;
  const auto n = static_cast<Eigen::Index>(layout.size());
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  Linearise(problem, layout, u.data(), pool, &hessian, &gradient);
  std::vector<int> active;
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const Coordinate& coordinate = layout.coordinates()[i];
    const double slack = 1e-9 * (coordinate.high - coordinate.low);
    // Only where the cost would go on falling beyond the bound is it the bound that decided.
    const auto slope = gradient(static_cast<Eigen::Index>(i));
    result.at_bound.push_back((u[i] <= coordinate.low + slack && slope >= 0) ||
                              (u[i] >= coordinate.high - slack && slope <= 0));
    if (!result.at_bound.back()) active.push_back(static_cast<int>(i));
  }
  result.covariance.setZero(n, n);
  result.clustered.setZero(n, n);
  const auto m = static_cast<Eigen::Index>(active.size());
  if (m == 0) return result;
  Eigen::MatrixXd h(m, m);
  for (Eigen::Index a = 0; a < m; ++a) {
    for (Eigen::Index b = 0; b < m; ++b)
      h(a, b) = hessian(active[static_cast<std::size_t>(a)], active[static_cast<std::size_t>(b)]);
  }
  const Eigen::VectorXd scale = h.diagonal().cwiseSqrt().unaryExpr([](double x) { return x > 0 ? x : 1.0; });
  const Eigen::VectorXd inverse_scale = scale.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(inverse_scale.asDiagonal() * h *
                                                             inverse_scale.asDiagonal());
  Eigen::VectorXd inverse_eigenvalue = eigen.eigenvalues();
  for (Eigen::Index k = 0; k < m; ++k) {
    const bool undetermined = inverse_eigenvalue(k) < kUndetermined;
    if (undetermined) {
      result.determined = false;
      result.degenerate.push_back(NameDirection(eigen.eigenvectors().col(k), active, layout));
    }
    inverse_eigenvalue(k) = undetermined ? 0.0 : 1 / inverse_eigenvalue(k);
  }
  const Eigen::MatrixXd bread = inverse_scale.asDiagonal() * eigen.eigenvectors() * inverse_eigenvalue.asDiagonal() *
                                eigen.eigenvectors().transpose() * inverse_scale.asDiagonal();
  const Meat meat = SumScores(problem, layout, u, incidences, pool);
  const auto sandwich = [&](const Eigen::MatrixXd& filling, double factor) {
    Eigen::MatrixXd b(m, m);
    for (Eigen::Index i = 0; i < m; ++i) {
      for (Eigen::Index j = 0; j < m; ++j)
        b(i, j) = filling(active[static_cast<std::size_t>(i)], active[static_cast<std::size_t>(j)]);
    }
    const Eigen::MatrixXd covariance = factor * bread * b * bread;
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < m; ++i) {
      for (Eigen::Index j = 0; j < m; ++j)
        full(active[static_cast<std::size_t>(i)], active[static_cast<std::size_t>(j)]) = covariance(i, j);
    }
    return full;
  };
  // Degrees of freedom: every channel of a sample is a residual, but a sample is one independent observation.
  const auto count = static_cast<double>(problem.size());
  const double parameters = static_cast<double>(m) / static_cast<double>(layout.channels());
  result.covariance = sandwich(meat.samples, count / std::max(1.0, count - parameters));
  const auto clusters = static_cast<double>(incidences.wi.size());
  result.has_clusters = clusters >= 2;
  if (result.has_clusters) {
    result.clustered = sandwich(meat.clusters.transpose() * meat.clusters,
                                clusters / (clusters - 1) * (count - 1) / std::max(1.0, count - parameters));
  }
  return result;
}

}  // namespace lobefit
