#include "lobefit/fit/errors/clusters.h"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

using Matrix = Eigen::MatrixXd;

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
    const Matrix root = InverseRootTimes(curvature, Matrix::Identity(6, 6));
    const Matrix one = root * root * (Matrix::Identity(6, 6) - curvature);
    EXPECT_LT((one - Matrix::Identity(6, 6)).norm(), 1e-11) << largest;
  }
}

TEST(InverseRoot, ADirectionOfOneClusterAloneIsLeftOut) {
  const Matrix curvature = WithEigenvalues(Eigen::Vector3d(0.2, 0.5, 1));
  const Matrix root = InverseRootTimes(curvature, Matrix::Identity(3, 3));
  const Eigen::VectorXd values = root.selfadjointView<Eigen::Lower>().eigenvalues();
  EXPECT_NEAR(values(0), 0, 1e-12);
  EXPECT_NEAR(values(1), 1 / std::sqrt(0.8), 1e-12);
  EXPECT_NEAR(values(2), 1 / std::sqrt(0.5), 1e-12);
}

// Channels that meet in a border of five only, as those of a spectrum: the same as by the eigenvectors of the whole.
TEST(InverseRoot, ZerosOfManyChannelsAreOnlyPassedOver) {
  constexpr Eigen::Index kBorder = 5, kSize = 225;
  Matrix curvature = Matrix::Zero(kSize, kSize);
  for (Eigen::Index i = 0; i < kSize; ++i) {
    const auto x = static_cast<double>(i);
    curvature(i, i) = 0.2 + 0.1 * std::sin(x);
    for (Eigen::Index k = 0; k < kBorder; ++k) {
      if (i > k) curvature(i, k) = curvature(k, i) = 0.01 * std::cos(3 * x + static_cast<double>(k));
    }
  }
  const Eigen::VectorXd score = Eigen::VectorXd::LinSpaced(kSize, -1, 2);
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(Matrix::Identity(kSize, kSize) - curvature);
  ASSERT_GT(eigen.eigenvalues()(0), 0.3);
  EXPECT_LT((InverseRootTimes(curvature, score) - eigen.operatorInverseSqrt() * score).norm(), 1e-12 * score.norm());
}

// A number at its bound has no part in any coordinate.
TEST(UnitColumns, ARowOfZerosStaysOne) {
  Eigen::MatrixXd rows(2, 3);
  rows << 2, 3, 6, 0, 0, 0;
  const Eigen::MatrixXd columns = UnitColumns(rows);
  EXPECT_TRUE(columns.col(0).isApprox(Eigen::Vector3d(2, 3, 6) / 7, 1e-15));
  EXPECT_TRUE(columns.col(1).isZero(0));
}

}  // namespace
}  // namespace lobefit
