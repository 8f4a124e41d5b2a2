#include "lobefit/fit/inference/uncertainty.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/text.h"
#include "lobefit/fit/search/solve.h"
#include "lobefit/fit/search/symmetric_eigen.h"

namespace lobefit {
namespace {

// Below this eigenvalue of the Gauss-Newton matrix, scaled to a unit diagonal, a direction is taken as not determined:
// its standard error is 1e5 times that of its coordinates alone.
constexpr double kUndetermined = 1e-10;

// Operations up to which leverages are computed, samples x (channels x coordinates^2 + what a sample takes anyway):
// about 0.1 s on one thread. Beyond it a sample weighs too little for them to matter.
constexpr double kMostLeverageWork = 1e8, kLeverageWorkOfSample = 300;

// The middle of the sandwich in whitened coordinates, in which H is the unit matrix.
struct Meat {
  Eigen::MatrixXd samples;   // m x m, sum over samples of s s^T
  Eigen::MatrixXd clusters;  // clusters x m, s a cluster
  // Gauss-Newton matrix of each cluster, m x m stacked; empty without leverages.
  Eigen::MatrixXd cluster_hessians;
};

// Coordinate of each column of channel `c` among the active ones, -1 for none; without the residual's column.
std::vector<int> ActiveColumns(const Layout& layout, std::size_t c, const std::vector<int>& place) {
  std::vector<int> columns;
  for (std::size_t k = 0; k < layout.shape_size(); ++k) columns.push_back(place[k]);
  for (const Layout::Linear& linear : layout.linear(c))
    columns.push_back(linear.index < 0 ? -1 : place[static_cast<std::size_t>(linear.index)]);
  return columns;
}

// (1 - P)^-1 r with P = B B^T, all eigenvalues in [0, 1): the geometric series. Where a sample is all that determines
// some direction the series does not converge and is cut: its residual is zero there anyway.
Eigen::VectorXd Inflated(const Eigen::MatrixXd& b, const Eigen::VectorXd& r) {
  constexpr int kMostTerms = 60;
  Eigen::VectorXd term = r, sum = r;
  for (int k = 1; k <= kMostTerms; ++k) {
    term = b * (b.transpose() * term);
    sum += term;
    if (term.squaredNorm() <= 1e-12 * sum.squaredNorm()) break;
  }
  return sum;
}

// With leverages: residuals of a sample are inflated by (1 - P_ii)^-1, since a fit bends towards the samples that weigh
// most in it and leaves them too small residuals [MacKinnon and White 1985, HC3]. With the power -1/2 (HC2) alpha_x of
// a metal with few samples in its highlight was covered in 93.3 % instead of 93.5 % of 1000 trials.
Meat SumWithLeverages(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                      const std::vector<int>& active, const Eigen::MatrixXd& whitening, const Incidences& incidences,
                      ThreadPool* pool) {
  const KernelModel kernel = layout.ToKernel(u.data());
  const Eigen::Index m = whitening.cols();
  const auto clusters = static_cast<Eigen::Index>(incidences.wi.size());
  std::vector<int> place(layout.size(), -1);
  for (std::size_t a = 0; a < active.size(); ++a) place[static_cast<std::size_t>(active[a])] = static_cast<int>(a);
  std::vector<std::vector<int>> columns;
  for (std::size_t c = 0; c < layout.channels(); ++c) columns.push_back(ActiveColumns(layout, c, place));
  const auto channels = static_cast<Eigen::Index>(layout.channels());
  const std::size_t runs = RunCount(problem.size());
  std::vector<Meat> partial(runs);
  pool->Run(runs, [&](std::size_t run) {
    Meat& meat = partial[run];
    meat.samples.setZero(m, m);
    meat.clusters.setZero(clusters, m);
    meat.cluster_hessians.setZero(clusters * m, m);
    const std::size_t last = RunBegin(problem.size(), run + 1);
    constexpr std::size_t kPiece = 256;
    std::vector<std::vector<double>> values;
    Eigen::MatrixXd b(channels, m);
    Eigen::VectorXd r(channels);
    for (std::size_t begin = RunBegin(problem.size(), run); begin < last; begin += kPiece) {
      const std::size_t count = std::min(last, begin + kPiece) - begin;
      Columns(problem.kernel_samples(), kernel, begin, begin + count, &values);
      for (std::size_t i = 0; i < count; ++i) {
        b.setZero();
        for (Eigen::Index c = 0; c < channels; ++c) {
          const std::vector<int>& to = columns[static_cast<std::size_t>(c)];
          const double* value = values[static_cast<std::size_t>(c)].data() + i;
          for (std::size_t j = 0; j < to.size(); ++j) {
            if (to[j] >= 0) b.row(c) += value[j * count] * whitening.row(to[j]);
          }
          r(c) = value[to.size() * count];
        }
        const Eigen::VectorXd score = b.transpose() * Inflated(b, r);
        meat.samples.selfadjointView<Eigen::Upper>().rankUpdate(score);
        const auto group = static_cast<Eigen::Index>(incidences.group[begin + i]);
        meat.clusters.row(group) += b.transpose() * r;
        meat.cluster_hessians.middleRows(group * m, m).noalias() += b.transpose() * b;
      }
    }
  });
  for (std::size_t run = 1; run < runs; ++run) {
    partial[0].samples += partial[run].samples;
    partial[0].clusters += partial[run].clusters;
    partial[0].cluster_hessians += partial[run].cluster_hessians;
  }
  partial[0].samples = Eigen::MatrixXd(partial[0].samples.selfadjointView<Eigen::Upper>());
  return partial[0];
}

// The same for clusters, (1 - H_g)^(-1/2) s_g [Bell and McCaffrey 2002, CR2]; directions that one cluster alone
// determines are left out: it has no residual there.
void InflateClusters(Meat* meat) {
  const Eigen::Index m = meat->clusters.cols();
  for (Eigen::Index g = 0; g < meat->clusters.rows(); ++g) {
    const SymmetricEigen eigen = DecomposeSymmetric(meat->cluster_hessians.middleRows(g * m, m));
    const Eigen::VectorXd factor =
        (1 - eigen.values.array()).unaryExpr([](double x) { return x > 1e-9 ? 1 / std::sqrt(x) : 0.0; });
    const Eigen::VectorXd score = meat->clusters.row(g).transpose();
    meat->clusters.row(g) = (eigen.vectors * (factor.asDiagonal() * (eigen.vectors.transpose() * score))).transpose();
  }
}

// Without leverages, for large problems in which no sample weighs much.
Meat SumScores(const Problem& problem, const Layout& layout, const std::vector<double>& u,
               const std::vector<int>& active, const Eigen::MatrixXd& whitening, const Incidences& incidences,
               ThreadPool* pool) {
  const KernelModel kernel = layout.ToKernel(u.data());
  const Eigen::Index m = whitening.cols(), n = whitening.rows();
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
        const std::vector<double>& from = gathered[static_cast<std::size_t>(active[static_cast<std::size_t>(j)])];
        std::copy(from.begin(), from.end(), s.col(j).data());
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
  // Degrees of freedom: every channel of a sample is a residual, but a sample is one independent observation.
  const auto count = static_cast<double>(problem.size()), groups = static_cast<double>(clusters);
  const double parameters = static_cast<double>(m) / static_cast<double>(layout.channels());
  const double factor = count / std::max(1.0, count - parameters);
  Meat meat;
  meat.samples = factor * whitening.transpose() * partial[0].samples * whitening;
  meat.clusters = std::sqrt(factor * groups / std::max(1.0, groups - 1)) * partial[0].clusters * whitening;
  return meat;
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
  const SymmetricEigen eigen = DecomposeSymmetric(inverse_scale.asDiagonal() * h * inverse_scale.asDiagonal());
  Eigen::VectorXd inverse_eigenvalue = eigen.values;
  for (Eigen::Index k = 0; k < m; ++k) {
    const bool undetermined = inverse_eigenvalue(k) < kUndetermined;
    if (undetermined) {
      result.determined = false;
      result.degenerate.push_back(NameDirection(eigen.vectors.col(k), active, layout));
    }
    inverse_eigenvalue(k) = undetermined ? 0.0 : 1 / inverse_eigenvalue(k);
  }
  // H^-1 = whitening whitening^T, with undetermined directions left out.
  const Eigen::MatrixXd whitening =
      inverse_scale.asDiagonal() * eigen.vectors * inverse_eigenvalue.cwiseSqrt().asDiagonal();
  const double work = static_cast<double>(problem.size()) *
                      (static_cast<double>(layout.channels()) * static_cast<double>(m * m) + kLeverageWorkOfSample);
  const bool with_leverages = work <= kMostLeverageWork;
  Meat meat = with_leverages ? SumWithLeverages(problem, layout, u, active, whitening, incidences, pool)
                             : SumScores(problem, layout, u, active, whitening, incidences, pool);
  if (with_leverages) InflateClusters(&meat);
  const auto spread = [&](const Eigen::MatrixXd& filling) {
    const Eigen::MatrixXd covariance = whitening * filling * whitening.transpose();
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < m; ++i) {
      for (Eigen::Index j = 0; j < m; ++j)
        full(active[static_cast<std::size_t>(i)], active[static_cast<std::size_t>(j)]) = covariance(i, j);
    }
    return full;
  };
  result.covariance = spread(meat.samples);
  result.has_clusters = incidences.wi.size() >= 2;
  if (result.has_clusters) result.clustered = spread(meat.clusters.transpose() * meat.clusters);
  return result;
}

}  // namespace lobefit
