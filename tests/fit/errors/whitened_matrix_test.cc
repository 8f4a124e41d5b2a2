#include "lobefit/fit/errors/whitened_matrix.h"

#include "tests/fit/errors/whitened.h"
#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

using Matrix = Eigen::MatrixXd;

// Pairs of two channels are zero in sums of rows of one channel each.
TEST(WhitenedMatrix, HoldsWhatIsAddedInBothForms) {
  for (const bool full : {true, false}) {
    ManyChannels many(4, full, 0.2);
    const double norm = many.dense.norm();
    EXPECT_LT((many.sum.Dense() - many.dense).norm(), 1e-14 * norm);
    EXPECT_NEAR(many.sum.Norm(), norm, 1e-14 * norm);
    EXPECT_LT((many.sum.Border() - many.dense.topLeftCorner(3, 3)).norm(), 1e-14 * norm);
    const Matrix vectors = Matrix::Random(many.form.size, 3);
    EXPECT_LT((many.sum.Times(vectors) - many.dense * vectors).norm(), 1e-13 * norm);
    SparseColumn z(many.form.size);
    for (const Eigen::Index i : {Eigen::Index{1}, many.form.first[2], many.form.first[2] + 1})
      z.insert(i) = 1 + 0.3 * static_cast<double>(i);
    EXPECT_NEAR(many.sum.Quadratic(z), Eigen::VectorXd(z).dot(many.dense * Eigen::VectorXd(z)), 1e-13 * norm);
    // Squares have pairs of two channels too, which only the full one keeps.
    const auto kept = [&](Matrix all) {
      for (Eigen::Index i = 3; i < all.rows() && !full; ++i) {
        for (Eigen::Index j = 3; j < all.cols(); ++j) {
          if ((i - 3) / ManyChannels::kOwn != (j - 3) / ManyChannels::kOwn) all(i, j) = 0;
        }
      }
      return all;
    };
    const Eigen::VectorXd square = Eigen::VectorXd::LinSpaced(many.form.size, -1, 2);
    many.sum.AddSquare(square);
    many.dense += kept(square * square.transpose());
    Matrix moves = Matrix::Zero(16, many.form.size);
    moves.topRows(11) = Matrix::Random(11, many.form.size);
    ProductSums products;
    many.sum.AddScatter(moves, 2, 9, 11, &products);
    many.dense += kept(moves.middleRows(2, 7).transpose() * moves.middleRows(2, 7));
    many.sum.AddToBorder(Matrix::Constant(3, 3, 0.5));
    many.sum.AddToBorder(Eigen::Vector3d(1, 2, 3), 0.25);
    many.dense.topLeftCorner(3, 3) +=
        Matrix::Constant(3, 3, 0.5) + 0.25 * Eigen::Vector3d(1, 2, 3) * Eigen::RowVector3d(1, 2, 3);
    many.sum += many.sum;
    EXPECT_LT((many.sum.Dense() - 2 * many.dense).norm(), 1e-13 * many.dense.norm()) << full;
  }
}

}  // namespace
}  // namespace lobefit
