#include "lobefit/fit/errors/freedom.h"

#include <cmath>

#include "tests/fit/errors/whitened.h"
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "lobefit/fit/errors/clusters.h"

namespace lobefit {
namespace {

using Matrix = Eigen::MatrixXd;

SparseColumns Sparse(const Matrix& numbers) { return numbers.sparseView(); }

// A cluster of so many samples that its scatter is known, with noise of the given variance; the unit of squares is 1.
Cluster Known(const ClusterTally& tally, const Matrix& curvature, double variance = 1) {
  const Matrix numbers = tally.freedom().numbers();
  Cluster cluster(tally.freedom());
  cluster.curvature.AddToBorder(curvature);
  if (tally.freedom().exact()) cluster.scatter.AddToBorder(variance * curvature);
  cluster.squares = variance * (numbers.transpose() * curvature * numbers).diagonal().array();
  return cluster;
}

Eigen::VectorXd FreedomOf(const ClusterTally& tally) { return tally.freedom().OfClusters(tally.scatter()); }

// G clusters that are all alike: G - 1 degrees of freedom, by the exact formula and by the one for many.
TEST(FreedomOfClusters, IsOneLessThanTheNumberOfEqualOnes) {
  const WhitenedForm form = FormOf(4);
  const SparseColumns numbers = Sparse(Matrix::Identity(4, 4));
  for (const std::size_t clusters : {2U, 3U, 8U, 36U, 100U, 101U, 5000U}) {
    const auto g = static_cast<double>(clusters);
    ClusterTally tally(form, numbers, clusters, 1);
    Cluster cluster = Known(tally, Matrix::Identity(4, 4) / g, 7);
    cluster.score.setOnes();
    for (std::size_t k = 0; k < clusters; ++k) tally.Add(cluster);
    for (const double freedom : FreedomOf(tally)) EXPECT_NEAR(freedom, g - 1, 1e-9 * g) << clusters;
    EXPECT_NEAR(tally.filling().Dense()(3, 0), g / (1 - 1 / g), 1e-9 * g);
  }
}

// Of clusters with a share in the curvature each, of any noise: the trace of the covariance of their parts, squared,
// over that of its square, with the covariance from the residual maker 1 - shares.
TEST(FreedomOfClusters, FollowsTheCovarianceOfTheirParts) {
  const WhitenedForm form = FormOf(1);
  const SparseColumns numbers = Sparse(Matrix::Identity(1, 1));
  const Eigen::Vector4d share(0.1, 0.2, 0.3, 0.4), variance(1, 8, 0.5, 2);
  ClusterTally tally(form, numbers, 4, 1);
  for (int g = 0; g < 4; ++g) tally.Add(Known(tally, Matrix::Constant(1, 1, share(g)), variance(g)));
  Matrix parts(4, 4);  // of the scores
  for (int g = 0; g < 4; ++g) {
    for (int k = 0; k < 4; ++k) parts(g, k) = ((g == k ? 1 : 0) - share(g)) / std::sqrt(1 - share(g));
  }
  const Matrix covariance = parts * share.cwiseProduct(variance).asDiagonal() * parts.transpose();
  const double trace = covariance.trace();
  EXPECT_NEAR(FreedomOf(tally)(0), trace * trace / covariance.squaredNorm(), 1e-12);
}

// Of many clusters, by the definition (freedom.h), for numbers of two coordinates of three.
TEST(FreedomOfClusters, OfManyFollowsTheDefinition) {
  constexpr std::size_t kClusters = 101;
  Matrix numbers(3, 2);
  numbers << 0.6, 0, 0, 0.28, -0.8, 0.96;
  const WhitenedForm form = FormOf(3);
  const SparseColumns sparse = Sparse(numbers);
  ClusterTally tally(form, sparse, kClusters, 1);
  Eigen::ArrayXXd h(kClusters, 2), v(kClusters, 2), fourth(kClusters, 2);
  for (std::size_t k = 0; k < kClusters; ++k) {
    const auto x = static_cast<double>(k);
    const auto row = static_cast<Eigen::Index>(k);
    Matrix curvature = Matrix::Identity(3, 3) * (0.01 + 0.005 * std::sin(x));
    curvature(0, 2) = curvature(2, 0) = 0.004 * std::cos(x);
    curvature(1, 2) = curvature(2, 1) = -0.003 * std::cos(2 * x);
    Cluster cluster = Known(tally, curvature, 1 + 0.9 * std::sin(5 * x));
    cluster.fourths = 0.3 * cluster.squares.square();
    tally.Add(cluster);
    h.row(row) = (numbers.transpose() * curvature * numbers).diagonal().array();
    v.row(row) = cluster.squares;
    fourth.row(row) = cluster.fourths;
  }
  for (Eigen::Index n = 0; n < 2; ++n) {
    const Eigen::ArrayXd e = h.col(n).square() / (1 - h.col(n));
    const double products = (e.sum() * e.sum() - e.square().sum()) * std::pow(v.col(n).sum() / h.col(n).sum(), 2);
    const double square = (v.col(n).square() - fourth.col(n) * 2 / 3).sum() + products;
    EXPECT_NEAR(FreedomOf(tally)(n), std::pow(v.col(n).sum(), 2) / square, 1e-10) << n;
  }
}

// One of ten clusters has nearly all the say: fewer than one degree of freedom is left over from it.
TEST(FreedomOfClusters, FallsWhereFewDecide) {
  const WhitenedForm form = FormOf(1);
  const SparseColumns numbers = Sparse(Matrix::Identity(1, 1));
  ClusterTally tally(form, numbers, 10, 1);
  tally.Add(Known(tally, Matrix::Constant(1, 1, 0.91)));
  for (int k = 0; k < 9; ++k) tally.Add(Known(tally, Matrix::Constant(1, 1, 0.01)));
  EXPECT_LT(FreedomOf(tally)(0), 1.25);
  EXPECT_GT(FreedomOf(tally)(0), 1);
}

// As many clusters with as much curvature, of which three are noisy.
TEST(FreedomOfClusters, FallsWhereFewAreNoisy) {
  const WhitenedForm form = FormOf(1);
  const SparseColumns numbers = Sparse(Matrix::Identity(1, 1));
  for (const std::size_t clusters : {90U, 300U}) {
    ClusterTally tally(form, numbers, clusters, 1);
    const Matrix curvature = Matrix::Constant(1, 1, 1 / static_cast<double>(clusters));
    for (std::size_t k = 0; k < clusters; ++k) tally.Add(Known(tally, curvature, k < 3 ? 1e4 : 1));
    EXPECT_NEAR(FreedomOf(tally)(0), 3, 0.2) << clusters;
  }
}

TEST(FreedomOfClusters, IsNoneWhereNoneHasAPartAndAnyWithoutNoise) {
  const WhitenedForm form = FormOf(2);
  const SparseColumns none = Sparse(Matrix::Zero(2, 1)), number = Sparse(Matrix::Identity(2, 1));
  ClusterTally without_part(form, none, 2, 1), without_noise(form, number, 2, 1);
  for (int k = 0; k < 2; ++k) {
    without_part.Add(Known(without_part, Matrix::Identity(2, 2) / 2));
    without_noise.Add(Known(without_noise, Matrix::Identity(2, 2) / 2, 0));
  }
  EXPECT_TRUE(std::isnan(FreedomOf(without_part)(0)));
  EXPECT_EQ(FreedomOf(without_noise)(0), INFINITY);
}

// N alike samples have N; of one that has all the say there is one, and none that counts has infinitely many.
TEST(FreedomOfSamples, IsTheNumberOfThoseThatDecide) {
  const WhitenedForm form = FormOf(1);
  const SparseColumns number = Sparse(Matrix::Identity(1, 1));
  for (const int decide : {1, 30}) {
    FreedomTally tally(form, number, 1, 1);
    Cluster cluster(tally);
    // Normal residuals in the mean: w^2 is three times the square of its mean.
    cluster.squares(0) = decide;
    cluster.fourths(0) = 3 * decide;
    tally.Add(cluster);
    EXPECT_NEAR(tally.OfSamples()(0), decide, 1e-12 * decide);
  }
  EXPECT_EQ(FreedomTally(form, number, 1, 1).OfSamples()(0), INFINITY);
}

// The unit of the values does not matter: squares of squares of the smallest residuals would be zero.
TEST(FreedomOfSamples, IsThatOfAnyUnit) {
  const WhitenedForm form = FormOf(2);
  const SparseColumns numbers = Sparse(Matrix::Identity(2, 2));
  Matrix moves(2, 3);
  moves << 1, -2, 3, 0.5, 0, -4;
  Eigen::VectorXd of_one;
  for (const double unit : {1.0, 1e-120, 1e120}) {
    ClusterTally tally(form, numbers, 2, unit * unit);
    for (int k = 0; k < 2; ++k) {
      Cluster cluster(tally.freedom());
      cluster.curvature.AddToBorder(Matrix::Identity(2, 2) / 2);
      const Eigen::ArrayXXd squares = tally.freedom().Squares(unit * moves.transpose());
      cluster.scatter.AddToBorder(unit * moves * (unit * moves).transpose());
      cluster.squares = squares.colwise().sum().transpose();
      cluster.fourths = squares.square().colwise().sum().transpose();
      tally.Add(cluster);
    }
    Eigen::VectorXd found(4);
    found << tally.freedom().OfSamples(), FreedomOf(tally);
    if (unit == 1) of_one = found;
    EXPECT_LT((found - of_one).norm(), 1e-12 * of_one.norm()) << unit;
  }
  EXPECT_TRUE(of_one.allFinite());
}

}  // namespace
}  // namespace lobefit
