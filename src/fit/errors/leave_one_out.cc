#include "lobefit/fit/errors/leave_one_out.h"

#include <cmath>

#include "lobefit/fit/errors/clusters.h"
#include "lobefit/fit/kernel/kernel_arrays.h"
#include "lobefit/fit/search/symmetric_eigen.h"

namespace lobefit {
namespace {

// A sample with less of the curvature is inverted by the series, which then has at most 32 terms.
constexpr double kSmall = 0.1;

// to += a b, arrays of n.
void AddProduct(const double* a, const double* b, Eigen::Index n, double* to) {
  arrays::AddFactor(a, 0, 1, b, static_cast<std::size_t>(n), to);
}

// to(i) = the dot product of the first `columns` entries of row i of both.
template <class Vector>
void DotRows(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, Eigen::Index columns, Vector* to) {
  to->setZero(a.rows());
  for (Eigen::Index j = 0; j < columns; ++j) AddProduct(a.col(j).data(), b.col(j).data(), a.rows(), to->data());
}

}  // namespace

const Eigen::MatrixXd& LeaveOneOut::Evaluate(const WhitenedPiece& piece) {
  Prepare(piece);
  for (Eigen::Index i = 0; i < piece.count(); ++i) {
    if (!(size_(i) < kSmall)) y_.row(i).setZero();
  }
  AddSeries(piece);
  for (Eigen::Index i = 0; i < piece.count() && bread_.form.border > 0; ++i) {
    if (!(size_(i) < kSmall)) y_.row(i) = Direct(piece, i).transpose();
  }
  moves_.resize(y_.rows(), bread_.form.size);
  moves_.leftCols(bread_.form.border) = y_;
  for (std::size_t c = 0; c < piece.rows.size(); ++c) {
    const Eigen::MatrixXd& rows = piece.rows[c];
    const auto channel = static_cast<Eigen::Index>(c);
    DotRows(rows, y_, bread_.form.border, &sum_);
    sum_ = w_.col(channel).array() * (residuals_.col(channel).array() + sum_);
    for (Eigen::Index j = 0; j < bread_.form.own[c]; ++j)
      arrays::Multiply(sum_.data(), rows.col(bread_.form.border + j).data(), static_cast<std::size_t>(rows.rows()),
                       moves_.col(bread_.form.first[c] + j).data());
  }
  return moves_;
}

// w, the right side in place of y, q where there is a loss, and how much of the curvature a sample has.
void LeaveOneOut::Prepare(const WhitenedPiece& piece) {
  const Eigen::Index padded = piece.rows[0].rows(), count = piece.count(), border = bread_.form.border;
  const auto channels = static_cast<Eigen::Index>(piece.rows.size());
  const bool bent = !piece.samples.curvature.isZero(0);
  residuals_.setZero(padded, channels);
  w_.resize(padded, channels);
  y_.setZero(padded, border);
  q_.setZero(padded, bent ? border : 0);
  size_.setZero(padded);
  for (Eigen::Index c = 0; c < channels; ++c) {
    const Eigen::MatrixXd& rows = piece.rows[static_cast<std::size_t>(c)];
    residuals_.col(c).head(count) = piece.samples.residuals[static_cast<std::size_t>(c)];
    sum_.setZero(padded);
    for (Eigen::Index j = border; j < rows.cols(); ++j)
      AddProduct(rows.col(j).data(), rows.col(j).data(), padded, sum_.data());
    w_.col(c) = sum_.unaryExpr([](double x) { return 1 - x > kAlone ? 1 / (1 - x) : 0.0; });
    DotRows(rows, rows, border, &sum_);
    size_ += w_.col(c).array() * sum_;
    sum_ = w_.col(c).array() * residuals_.col(c).array();
    for (Eigen::Index j = 0; j < border; ++j) AddProduct(sum_.data(), rows.col(j).data(), padded, y_.col(j).data());
    for (Eigen::Index j = 0; j < q_.cols(); ++j)
      AddProduct(residuals_.col(c).data(), rows.col(j).data(), padded, q_.col(j).data());
  }
  if (bent)
    size_.head(count) += piece.samples.curvature.array().abs() * q_.topRows(count).rowwise().squaredNorm().array();
}

// y and what the powers of the curvature make of it.
void LeaveOneOut::AddSeries(const WhitenedPiece& piece) {
  const Eigen::Index padded = y_.rows(), border = bread_.form.border;
  const auto channels = static_cast<Eigen::Index>(piece.rows.size());
  term_ = y_;
  Eigen::ArrayXd of_term, of_y;
  while (true) {
    DotRows(term_, term_, border, &of_term);
    DotRows(y_, y_, border, &of_y);
    if (!(of_term > 1e-32 * of_y).any()) return;  // nor where a number is not finite
    next_.setZero(padded, border);
    for (Eigen::Index c = 0; c < channels; ++c) {
      const Eigen::MatrixXd& rows = piece.rows[static_cast<std::size_t>(c)];
      DotRows(rows, term_, border, &sum_);
      sum_ *= w_.col(c).array();
      for (Eigen::Index j = 0; j < border; ++j)
        AddProduct(sum_.data(), rows.col(j).data(), padded, next_.col(j).data());
    }
    if (q_.cols() > 0) {
      DotRows(q_, term_, border, &sum_);
      sum_.head(piece.count()) *= piece.samples.curvature.array();
      for (Eigen::Index j = 0; j < border; ++j) AddProduct(sum_.data(), q_.col(j).data(), padded, next_.col(j).data());
    }
    term_.swap(next_);
    y_ += term_;
  }
}

// y of one sample by eigenvectors; directions that it alone determines are left out.
Eigen::VectorXd LeaveOneOut::Direct(const WhitenedPiece& piece, Eigen::Index i) const {
  const Eigen::Index border = bread_.form.border;
  Eigen::MatrixXd left = Eigen::MatrixXd::Identity(border, border);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(border);
  if (q_.cols() > 0) left -= piece.samples.curvature(i) * q_.row(i).transpose() * q_.row(i);
  for (Eigen::Index c = 0; c < w_.cols(); ++c) {
    const Eigen::VectorXd k = piece.rows[static_cast<std::size_t>(c)].row(i).head(border).transpose();
    left -= w_(i, c) * k * k.transpose();
    right += w_(i, c) * residuals_(i, c) * k;
  }
  const SymmetricEigen eigen = DecomposeSymmetric(left);
  const Eigen::VectorXd inverse = eigen.values.unaryExpr([](double x) { return x > kAlone ? 1 / x : 0.0; });
  return eigen.vectors * (inverse.asDiagonal() * (eigen.vectors.transpose() * right));
}

}  // namespace lobefit
