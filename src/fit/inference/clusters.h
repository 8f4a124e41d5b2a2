// The sandwich's filling from clusters of samples that may depend on each other, with the correction for how far the
// fit bends towards each cluster, and the degrees of freedom of what comes out.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace lobefit {

// A direction in which a sample's part of the curvature is this near to all of it has no residual but that sample's,
// which is zero there.
inline constexpr double kAlone = 1e-9;

// Sums over the samples of one cluster, in whitened coordinates (bread.h).
struct Cluster {
  Eigen::MatrixXd curvature;  // m x m: the cluster's part of the second derivatives, which add up to the unit matrix
  Eigen::VectorXd score;      // m: its part of the gradient
};

// (1 - curvature)^(-1/2) times the columns of `vectors`. Directions that the cluster alone determines (curvature above
// 1 - 1e-9) are left out: it has no residual there. `curvature`: symmetric, below 1 but for rounding.
Eigen::MatrixXd InverseRootTimes(const Eigen::MatrixXd& curvature, const Eigen::MatrixXd& vectors);

// The rows as columns of length 1. One of zeros, such as that of a number at its bound, stays one: NaN in all of it would
// make a fit with 800 channels twice as long.
Eigen::MatrixXd UnitColumns(const Eigen::MatrixXd& rows);

// CR2 [Bell and McCaffrey 2002]: the filling is the sum of a a^T with a = (1 - curvature)^(-1/2) score, which has no
// bias where residuals are independent and of one variance. For a number z^T a of the whitened coordinates the degrees
// of freedom are those of the chi-square with the mean and variance that its estimated variance has there [Bell and
// McCaffrey 2002, with the square of the trace over the trace of the square as in Imbens and Kolesar 2016]:
// G - 1 for G equal clusters, fewer where few of them decide.
class ClusterTally {
 public:
  // `numbers`: m x numbers, z each; kept by reference. `clusters`: how many will be added.
  ClusterTally(const Eigen::MatrixXd& numbers, std::size_t clusters);

  void Add(const Cluster& cluster);
  // Adds what another tally of the same fit has; the order is that of the clusters.
  void Merge(const ClusterTally& other);

  const Eigen::MatrixXd& filling() const { return filling_; }
  // A number each; NaN where no cluster has a part in it. Up to 100 clusters exactly; of more, where it decides
  // nothing, with each cluster's curvature taken as a multiple of the unit matrix.
  Eigen::VectorXd DegreesOfFreedom() const;

 private:
  const Eigen::MatrixXd* numbers_;
  bool exact_;
  // Of `numbers`, without `exact_`: a number of one of many channels depends on the shape and its own channel only.
  Eigen::SparseMatrix<double> sparse_;
  Eigen::MatrixXd filling_;
  // With h = z^T curvature z the cluster's share in the variance of a number, sums of h and h^2; and without `exact_`
  // of e = h^2 / (1 - h) and e^2, with h as a part of z^T z.
  Eigen::ArrayXd h_, h2_, e_, e2_;
  // Curvature (1 - curvature)^(-1/2) z, cluster by cluster, for `exact_`.
  std::vector<Eigen::MatrixXd> influence_;
};

}  // namespace lobefit
