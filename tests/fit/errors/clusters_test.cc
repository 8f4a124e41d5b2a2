#include "lobefit/fit/errors/clusters.h"

#include <cmath>

#include "tests/fit/errors/whitened.h"
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "lobefit/fit/errors/sandwich.h"

namespace lobefit {
namespace {

using Matrix = Eigen::MatrixXd;

Matrix InverseRootOf(const Matrix& curvature, const Matrix& vectors) {
  const WhitenedForm form = FormOf(curvature.rows());
  WhitenedMatrix whitened(form);
  whitened.AddToBorder(curvature);
  return InverseRootTimes(whitened, vectors);
}

// A symmetric matrix of the given eigenvalues in some orthonormal frame.
Matrix WithEigenvalues(const Eigen::VectorXd& values) {
  Matrix random(values.size(), values.size());
  for (Eigen::Index i = 0; i < random.size(); ++i) random.data()[i] = std::sin(1.0 + 7.3 * static_cast<double>(i * i));
  const Matrix frame = random.householderQr().householderQ();
  return frame * values.asDiagonal() * frame.transpose();
}

TEST(InverseRoot, SeriesAndEigenvectorsAgree) {
  for (const double largest : {0.01, 0.3, 0.6, 0.9, 0.999}) {
    const Matrix curvature = WithEigenvalues(Eigen::VectorXd::LinSpaced(6, -0.2 * largest, largest));
    const Matrix root = InverseRootOf(curvature, Matrix::Identity(6, 6));
    const Matrix one = root * root * (Matrix::Identity(6, 6) - curvature);
    EXPECT_LT((one - Matrix::Identity(6, 6)).norm(), 1e-11) << largest;
  }
}

TEST(InverseRoot, ADirectionOfOneClusterAloneIsLeftOut) {
  const Matrix curvature = WithEigenvalues(Eigen::Vector3d(0.2, 0.5, 1));
  const Matrix root = InverseRootOf(curvature, Matrix::Identity(3, 3));
  const Eigen::VectorXd values = root.selfadjointView<Eigen::Lower>().eigenvalues();
  EXPECT_NEAR(values(0), 0, 1e-12);
  EXPECT_NEAR(values(1), 1 / std::sqrt(0.8), 1e-12);
  EXPECT_NEAR(values(2), 1 / std::sqrt(0.5), 1e-12);
}

// Channels that meet in a border only, as those of a spectrum: the same as by the eigenvectors of the whole.
TEST(InverseRoot, OfManyChannelsIsThatOfTheWhole) {
  const ManyChannels many(100, false, 0.04);
  const Eigen::Index size = many.form.size;
  const Eigen::VectorXd score = Eigen::VectorXd::LinSpaced(size, -1, 2);
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(Matrix::Identity(size, size) - many.dense);
  ASSERT_GT(eigen.eigenvalues()(0), 0.3);
  ASSERT_LT(eigen.eigenvalues()(0), 0.7);
  EXPECT_LT((InverseRootTimes(many.sum, score) - eigen.operatorInverseSqrt() * score).norm(), 1e-12 * score.norm());
}

// Of more coordinates than kMostFull, with one direction that the cluster alone determines and others near it: by
// powers.
TEST(InverseRoot, OfManyChannelsThatAClusterNearlyDecides) {
  constexpr Eigen::Index kSize = 450;
  const Eigen::VectorXd score = Eigen::VectorXd::LinSpaced(kSize, -1, 2);
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(kSize, 0, 0.9);
  values.tail(4) << 0.99, 0.999, 0.9999, 1;
  const Matrix curvature = WithEigenvalues(values);
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(curvature);
  const Eigen::VectorXd factor =
      eigen.eigenvalues().unaryExpr([](double x) { return 1 - x > kAlone ? 1 / std::sqrt(1 - x) : 0.0; });
  const Eigen::VectorXd expected = eigen.eigenvectors() * factor.cwiseProduct(eigen.eigenvectors().transpose() * score);
  EXPECT_LT((InverseRootOf(curvature, score) - expected).norm(), 1e-8 * expected.norm());
}

// A number at its bound has no part in any coordinate.
TEST(UnitColumns, ARowOfZerosStaysOne) {
  Eigen::MatrixXd rows(2, 3);
  rows << 2, 3, 6, 0, 0, 0;
  SparseRows sparse = rows.sparseView();
  sparse.insert(1, 2) = 0;  // as products leave them
  const Eigen::MatrixXd columns = UnitColumns(sparse);
  EXPECT_TRUE(columns.col(0).isApprox(Eigen::Vector3d(2, 3, 6) / 7, 1e-15));
  EXPECT_TRUE(columns.col(1).isZero(0));
}

}  // namespace
}  // namespace lobefit
