#include "lobefit/fit/inference/times_inverse.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/SparseCholesky>

#include "lobefit/fit/search/symmetric_eigen.h"

namespace lobefit {
namespace {

Eigen::SparseMatrix<double> Sparse(const ArrowMatrix& arrow, Eigen::Index size) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto put = [&entries](const std::vector<int>& rows, const std::vector<int>& columns,
                              const Eigen::MatrixXd& block) {
    for (std::size_t j = 0; j < columns.size(); ++j) {
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const double value = block(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        entries.emplace_back(std::min(rows[i], columns[j]), std::max(rows[i], columns[j]), value);
      }
    }
  };
  const auto put_half = [&put](const std::vector<int>& coordinates, const Eigen::MatrixXd& block) {
    put(coordinates, coordinates, block.triangularView<Eigen::Upper>());
  };
  put_half(arrow.shape.border, arrow.border);
  for (std::size_t c = 0; c < arrow.own.size(); ++c) {
    put(arrow.shape.border, arrow.shape.own[c], arrow.across[c]);
    put_half(arrow.shape.own[c], arrow.own[c]);
  }
  Eigen::SparseMatrix<double> sparse(size, size);  // upper half
  sparse.setFromTriplets(entries.begin(), entries.end());
  return sparse;
}

}  // namespace

Eigen::MatrixXd TimesInverse(const Eigen::MatrixXd& rows, const ArrowMatrix& hessian) {
  if (rows.cols() == 0) return rows;
  const Eigen::VectorXd scale = hessian.Diagonal().unaryExpr([](double x) { return x > 0 ? 1 / std::sqrt(x) : 1.0; });
  constexpr double kHair = 1e-10;
  // A factorisation keeps the zeros of many channels, where an inverse took a sixth of a fit with 800 of them. A hair
  // of curvature holds what is not determined.
  constexpr Eigen::Index kMostDecomposed = 200;
  if (rows.cols() > kMostDecomposed) {
    Eigen::SparseMatrix<double> scaled = Sparse(hessian, rows.cols());
    scaled = (scale.asDiagonal() * scaled * scale.asDiagonal()).eval();
    for (Eigen::Index i = 0; i < scaled.rows(); ++i) scaled.coeffRef(i, i) += kHair;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Upper> factor(scaled);
    const Eigen::MatrixXd right = scale.asDiagonal() * rows.transpose();
    return (scale.asDiagonal() * factor.solve(right)).transpose();
  }
  const SymmetricEigen eigen = DecomposeSymmetric(scale.asDiagonal() * hessian.Dense() * scale.asDiagonal());
  const Eigen::VectorXd inverse = eigen.values.unaryExpr([](double x) { return x > kHair ? 1 / x : 0.0; });
  const Eigen::MatrixXd half = scale.asDiagonal() * eigen.vectors;
  return rows * Eigen::MatrixXd(half * inverse.asDiagonal() * half.transpose());
}

}  // namespace lobefit
