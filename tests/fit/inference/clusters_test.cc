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

// G clusters that are all alike: G - 1 degrees of freedom, by the exact formula and by the one for many.
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
