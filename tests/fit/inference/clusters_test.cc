#include "lobefit/fit/inference/clusters.h"

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

// G clusters that are all alike: G - 1 degrees of freedom, by the exact formula and by the one for many.
// A number at its bound has no part in any coordinate.
TEST(UnitColumns, ARowOfZerosStaysOne) {
  Eigen::MatrixXd rows(2, 3);
  rows << 2, 3, 6, 0, 0, 0;
  const Eigen::MatrixXd columns = UnitColumns(rows);
  EXPECT_TRUE(columns.col(0).isApprox(Eigen::Vector3d(2, 3, 6) / 7, 1e-15));
  EXPECT_TRUE(columns.col(1).isZero(0));
}

TEST(DegreesOfFreedom, AreOneLessThanTheNumberOfEqualClusters) {
  const Matrix numbers = Matrix::Identity(4, 4);
  for (const std::size_t clusters : {2U, 3U, 8U, 36U, 100U, 101U, 5000U}) {
    const auto g = static_cast<double>(clusters);
    ClusterTally tally(numbers, clusters);
    for (std::size_t k = 0; k < clusters; ++k) tally.Add({Matrix::Identity(4, 4) / g, Eigen::VectorXd::Ones(4)});
    for (const double freedom : tally.DegreesOfFreedom()) EXPECT_NEAR(freedom, g - 1, 1e-9 * g) << clusters;
    EXPECT_NEAR(tally.filling()(3, 0), g / (1 - 1 / g), 1e-9 * g);
  }
}

// Of many clusters, by the definition (clusters.h), for numbers of two coordinates of three.
TEST(DegreesOfFreedom, OfManyClustersFollowTheDefinition) {
  constexpr std::size_t kClusters = 101;
  Matrix numbers(3, 2);
  numbers << 0.6, 0, 0, 0.28, -0.8, 0.96;
  ClusterTally tally(numbers, kClusters);
  Eigen::ArrayXXd h(kClusters, 2);
  for (std::size_t k = 0; k < kClusters; ++k) {
    const auto x = static_cast<double>(k);
    Matrix curvature = Matrix::Identity(3, 3) * (0.01 + 0.005 * std::sin(x));
    curvature(0, 2) = curvature(2, 0) = 0.004 * std::cos(x);
    curvature(1, 2) = curvature(2, 1) = -0.003 * std::cos(2 * x);
    tally.Add({curvature, Eigen::VectorXd::Ones(3)});
    for (Eigen::Index n = 0; n < 2; ++n)
      h(static_cast<Eigen::Index>(k), n) = numbers.col(n).dot(curvature * numbers.col(n));
  }
  for (Eigen::Index n = 0; n < 2; ++n) {
    const Eigen::ArrayXd e = h.col(n).square() / (1 - h.col(n));
    const double sum = h.col(n).sum(), products = e.sum() * e.sum() - e.square().sum();
    EXPECT_NEAR(tally.DegreesOfFreedom()(n), sum * sum / (h.col(n).square().sum() + products), 1e-10) << n;
  }
}

// One of two clusters has nearly all the say: fewer than one degree of freedom is left over from it.
TEST(DegreesOfFreedom, FallWhereFewClustersDecide) {
  const Matrix numbers = Matrix::Identity(1, 1);
  ClusterTally tally(numbers, 10);
  tally.Add({Matrix::Constant(1, 1, 0.91), Eigen::VectorXd::Ones(1)});
  for (int k = 0; k < 9; ++k) tally.Add({Matrix::Constant(1, 1, 0.01), Eigen::VectorXd::Ones(1)});
  EXPECT_LT(tally.DegreesOfFreedom()(0), 1.25);
  EXPECT_GT(tally.DegreesOfFreedom()(0), 1);
}

TEST(DegreesOfFreedom, AreNoneWhereNoClusterHasAPart) {
  const Matrix numbers = Matrix::Zero(2, 1);
  ClusterTally tally(numbers, 2);
  for (int k = 0; k < 2; ++k) tally.Add({Matrix::Identity(2, 2) / 2, Eigen::VectorXd::Ones(2)});
  EXPECT_TRUE(std::isnan(tally.DegreesOfFreedom()(0)));
}

}  // namespace
}  // namespace lobefit
