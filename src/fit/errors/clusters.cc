#include "lobefit/fit/errors/clusters.h"

#include <algorithm>
#include <cmath>

#include "lobefit/fit/search/symmetric_eigen.h"

namespace lobefit {
namespace {

// Of a positive matrix, from below, by powers of it.
double LargestEigenvalue(const WhitenedMatrix& matrix, Eigen::Index size) {
  constexpr int kPowers = 20;
  Eigen::VectorXd v = Eigen::VectorXd::Ones(size);
  double value = 0;
  for (int k = 0; k < kPowers; ++k) {
    v.normalize();
    v = matrix.Times(v);
    value = v.norm();
  }
  return value;
}

// (1 - curvature)^(-1/2) times the vectors by the power series, where that takes fewer operations than eigenvectors.
// The norm is that of many channels' many small parts, of which none is near 1; the powers tell, and the series itself,
// whether they told right.
bool BySeries(const WhitenedMatrix& curvature, const Eigen::MatrixXd& vectors, Eigen::MatrixXd* result) {
  const double norm = std::min(curvature.Norm(), LargestEigenvalue(curvature, vectors.rows()));
  const double terms = norm < 1 ? 36 / -std::log(norm) : INFINITY;
  const auto rows = static_cast<double>(vectors.rows()), columns = static_cast<double>(vectors.cols());
  if (!(terms * columns <= 5 * rows + 2 * columns)) return false;
  Eigen::MatrixXd term = vectors;
  *result = vectors;
  for (int k = 1; k < 2 * terms + 10; ++k) {
    term = curvature.Times(term * ((k - 0.5) / k));
    *result += term;
    if (term.squaredNorm() <= 1e-32 * result->squaredNorm()) return true;
  }
  return false;
}

double InverseRoot(double eigenvalue) { return 1 - eigenvalue > kAlone ? 1 / std::sqrt(1 - eigenvalue) : 0.0; }

// The same of one vector in the space of its powers [Lanczos 1950, with all earlier directions taken out again]: where
// a cluster has nearly all the say in some of thousands of coordinates the series is endless, and eigenvectors of all
// take minutes. Of 6406 coordinates, where the series took hundreds of terms, 40 to 80 powers do. False where the
// answer still moves by more than a billionth after kMostPowers.
bool ByPowers(const WhitenedMatrix& curvature, const Eigen::VectorXd& vector, Eigen::MatrixXd* result) {
  constexpr Eigen::Index kMostPowers = 400, kEvery = 20;
  const double length = vector.norm();
  if (!(length > 0)) return false;
  Eigen::MatrixXd basis(vector.size(), kMostPowers), projected = Eigen::MatrixXd::Zero(kMostPowers, kMostPowers);
  basis.col(0) = vector / length;
  Eigen::VectorXd before;
  for (Eigen::Index k = 1; k <= kMostPowers; ++k) {
    const auto known = basis.leftCols(k);
    Eigen::VectorXd next = curvature.Times(basis.col(k - 1)).col(0);
    projected(k - 1, k - 1) = basis.col(k - 1).dot(next);
    for (int twice = 0; twice < 2; ++twice) next -= known * (known.transpose() * next).eval();
    const double beta = next.norm();
    const bool closed = beta <= 1e-14;  // of a matrix of norm 1
    if (closed || k % kEvery == 0) {
      const SymmetricEigen eigen = DecomposeSymmetric(projected.topLeftCorner(k, k));
      const Eigen::VectorXd factor = eigen.values.unaryExpr(&InverseRoot);
      const Eigen::VectorXd now = eigen.vectors * factor.cwiseProduct(eigen.vectors.row(0).transpose());
      const double moved = before.size() == 0
                               ? INFINITY
                               : (now.head(before.size()) - before).norm() + now.tail(k - before.size()).norm();
      if (closed || moved <= 1e-9 * now.norm()) {
        *result = length * (known * now);
        return true;
      }
      before = now;
    }
    if (k == kMostPowers) return false;
    projected(k, k - 1) = projected(k - 1, k) = beta;
    basis.col(k) = next / beta;
  }
  return false;
}

}  // namespace

Eigen::MatrixXd InverseRootTimes(const WhitenedMatrix& curvature, const Eigen::MatrixXd& vectors) {
  Eigen::MatrixXd result;
  const bool large = vectors.rows() > static_cast<Eigen::Index>(kMostFull);
  if (large && vectors.cols() == 1 && ByPowers(curvature, vectors.col(0), &result)) return result;
  if (BySeries(curvature, vectors, &result)) return result;
  const SymmetricEigen eigen = DecomposeSymmetric(curvature.Dense());
  const Eigen::VectorXd factor = eigen.values.unaryExpr(&InverseRoot);
  return eigen.vectors * (factor.asDiagonal() * (eigen.vectors.transpose() * vectors));
}

Cluster::Cluster(const FreedomTally& freedom) : curvature(freedom.form()) {
  score.setZero(freedom.form().size);
  if (freedom.exact()) scatter = WhitenedMatrix(freedom.form());
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

ClusterTally::ClusterTally(const WhitenedForm& form, const SparseColumns& numbers, std::size_t clusters,
                           double residual_variance)
    : filling_(form), scatter_(form), freedom_(form, numbers, clusters, residual_variance) {}

void ClusterTally::Add(const Cluster& cluster) {
  filling_.AddSquare(InverseRootTimes(cluster.curvature, cluster.score));
  scatter_ += cluster.scatter;
  freedom_.Add(cluster);
}

void ClusterTally::AddScatter(const Eigen::MatrixXd& moves, Eigen::Index count, ProductSums* sums) {
  scatter_.AddScatter(moves, 0, count, count, sums);
}

void ClusterTally::Merge(const ClusterTally& other) {
  filling_ += other.filling_;
  scatter_ += other.scatter_;
  freedom_.Merge(other.freedom_);
}

}  // namespace lobefit
