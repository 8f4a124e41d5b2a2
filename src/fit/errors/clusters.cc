#include "lobefit/fit/errors/clusters.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCore>

#include "lobefit/fit/search/symmetric_eigen.h"

namespace lobefit {
namespace {

// Of a positive matrix, from below, by powers of it.
template <class Matrix>
double LargestEigenvalue(const Matrix& matrix) {
  constexpr int kPowers = 20;
  Eigen::VectorXd v = Eigen::VectorXd::Ones(matrix.rows());
  double value = 0;
  for (int k = 0; k < kPowers; ++k) {
    v.normalize();
    v = (matrix * v).eval();
    value = v.norm();
  }
  return value;
}

// (1 - curvature)^(-1/2) times the vectors by the power series, where that takes fewer operations than eigenvectors.
// The norm is that of many channels' many small parts, of which none is near 1; the powers tell, and the series itself,
// whether they told right.
template <class Matrix>
bool BySeries(const Matrix& curvature, const Eigen::MatrixXd& vectors, Eigen::MatrixXd* result) {
  const double norm = std::min(curvature.norm(), LargestEigenvalue(curvature));
  const double terms = norm < 1 ? 36 / -std::log(norm) : INFINITY;
  const auto rows = static_cast<double>(curvature.rows()), columns = static_cast<double>(vectors.cols());
  if (!(terms * columns <= 5 * rows + 2 * columns)) return false;
  Eigen::MatrixXd term = vectors;
  *result = vectors;
  for (int k = 1; k < 2 * terms + 10; ++k) {
    term = (curvature * term * ((k - 0.5) / k)).eval();
    *result += term;
    if (term.squaredNorm() <= 1e-32 * result->squaredNorm()) return true;
  }
  return false;
}

}  // namespace

Eigen::MatrixXd InverseRootTimes(const Eigen::MatrixXd& curvature, const Eigen::MatrixXd& vectors) {
  Eigen::MatrixXd result;
  const bool done = curvature.rows() < kLeastSparse
                        ? BySeries(curvature, vectors, &result)
                        : BySeries(Eigen::SparseMatrix<double>(curvature.sparseView()), vectors, &result);
  if (done) return result;
  const SymmetricEigen eigen = DecomposeSymmetric(curvature);
  const Eigen::VectorXd factor =
      (1 - eigen.values.array()).unaryExpr([](double x) { return x > kAlone ? 1 / std::sqrt(x) : 0.0; });
  return eigen.vectors * (factor.asDiagonal() * (eigen.vectors.transpose() * vectors));
}

Eigen::MatrixXd UnitColumns(const Eigen::MatrixXd& rows) {
  Eigen::MatrixXd columns = rows.transpose();
  for (Eigen::Index k = 0; k < columns.cols(); ++k) columns.col(k).normalize();
  return columns;
}

Cluster::Cluster(const FreedomTally& freedom) {
  const Eigen::Index m = freedom.numbers().rows();
  curvature.setZero(m, m);
  score.setZero(m);
  if (freedom.exact()) scatter.setZero(m, m);
  squares.setZero(freedom.numbers().cols());
  fourths.setZero(freedom.numbers().cols());
}

void Cluster::Add(const Cluster& other) {
  curvature += other.curvature;
  score += other.score;
  scatter += other.scatter;
  squares += other.squares;
  fourths += other.fourths;
}

ClusterTally::ClusterTally(const Eigen::MatrixXd& numbers, std::size_t clusters, double residual_variance)
    : freedom_(numbers, clusters, residual_variance) {}

void ClusterTally::MakeRoom(Eigen::MatrixXd* matrix) const {
  if (matrix->size() == 0) matrix->setZero(freedom_.numbers().rows(), freedom_.numbers().rows());
}

void ClusterTally::Add(const Cluster& cluster) {
  MakeRoom(&filling_);
  if (freedom_.exact()) MakeRoom(&scatter_);
  filling_.selfadjointView<Eigen::Lower>().rankUpdate(InverseRootTimes(cluster.curvature, cluster.score));
  if (freedom_.exact()) scatter_ += cluster.scatter;
  freedom_.Add(cluster);
}

void ClusterTally::AddScatter(const ProductSums& of_samples) {
  MakeRoom(&scatter_);
  of_samples.AddTo([](Eigen::Index k) { return k; }, &scatter_);
}

void ClusterTally::Merge(const ClusterTally& other) {
  const auto add = [this](const Eigen::MatrixXd& from, Eigen::MatrixXd* to) {
    if (from.size() == 0) return;
    MakeRoom(to);
    *to += from;
  };
  add(other.filling_, &filling_);
  add(other.scatter_, &scatter_);
  freedom_.Merge(other.freedom_);
}

}  // namespace lobefit
