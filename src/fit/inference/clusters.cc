#include "lobefit/fit/inference/clusters.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCore>

#include "lobefit/fit/search/symmetric_eigen.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostExact = 100;
// Numbers of 8 bytes that the exact degrees of freedom may store.
constexpr double kMostStored = 4e6;

// From here on the curvature of many channels, which meet in the few columns of the shape only, is mostly zeros: its
// products with a vector took half of a fit with 800 channels.
constexpr Eigen::Index kLeastSparse = 200;

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

ClusterTally::ClusterTally(const Eigen::MatrixXd& numbers, std::size_t clusters)
    : numbers_(&numbers),
      exact_(clusters <= kMostExact &&
             static_cast<double>(clusters) * static_cast<double>(numbers.size()) <= kMostStored),
      filling_(Eigen::MatrixXd::Zero(numbers.rows(), numbers.rows())) {
  h_ = h2_ = e_ = e2_ = Eigen::ArrayXd::Zero(numbers.cols());
  if (!exact_) sparse_ = numbers.sparseView();
}

void ClusterTally::Add(const Cluster& cluster) {
  const Eigen::VectorXd inflated = InverseRootTimes(cluster.curvature, cluster.score);
  filling_.selfadjointView<Eigen::Lower>().rankUpdate(inflated);
  if (exact_) {
    const Eigen::MatrixXd root = InverseRootTimes(cluster.curvature, *numbers_);
    influence_.push_back(cluster.curvature * root);
    const Eigen::MatrixXd& influence = influence_.back();
    const Eigen::ArrayXd h = (root - influence).cwiseProduct(influence).colwise().sum().transpose();
    h_ += h;
    h2_ += h.square();
    return;
  }
  Eigen::ArrayXd h(sparse_.cols());
  for (Eigen::Index k = 0; k < sparse_.cols(); ++k) {
    double sum = 0;
    for (Eigen::SparseMatrix<double>::InnerIterator i(sparse_, k); i; ++i) {
      for (Eigen::SparseMatrix<double>::InnerIterator j(sparse_, k); j; ++j)
        sum += i.value() * cluster.curvature(i.row(), j.row()) * j.value();
    }
    h(k) = sum;
  }
  h_ += h;
  h2_ += h.square();
  const Eigen::ArrayXd length = numbers_->colwise().squaredNorm().transpose();
  const Eigen::ArrayXd part = (h / length).min(1 - kAlone);
  const Eigen::ArrayXd e = part.square() / (1 - part);
  e_ += e;
  e2_ += e.square();
}

void ClusterTally::Merge(const ClusterTally& other) {
  filling_ += other.filling_;
  h_ += other.h_;
  h2_ += other.h2_;
  e_ += other.e_;
  e2_ += other.e2_;
  influence_.insert(influence_.end(), other.influence_.begin(), other.influence_.end());
}

Eigen::VectorXd ClusterTally::DegreesOfFreedom() const {
  // The variance of a number is estimated as a quadratic form of the residuals whose matrix has the trace sum of h, and
  // whose square the trace sum of h^2 and of the squared products of the influences of any two clusters.
  Eigen::ArrayXd products = Eigen::ArrayXd::Zero(numbers_->cols());
  if (exact_) {
    for (std::size_t g = 0; g < influence_.size(); ++g) {
      for (std::size_t k = 0; k < g; ++k)
        products += 2 * influence_[g].cwiseProduct(influence_[k]).colwise().sum().transpose().array().square();
    }
  } else {
    const Eigen::ArrayXd length = numbers_->colwise().squaredNorm().transpose();
    products = (e_.square() - e2_) * length.square();
  }
  return h_.square() / (h2_ + products);
}

}  // namespace lobefit
