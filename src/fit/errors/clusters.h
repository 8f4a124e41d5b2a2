// The sandwich's filling from clusters of samples that may depend on each other, with the correction for how far the
// fit bends towards each cluster.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "lobefit/fit/errors/freedom.h"
#include "lobefit/fit/errors/product_sums.h"

namespace lobefit {

// A direction in which a sample's part of the curvature is this near to all of it has no residual but that sample's,
// which is zero there.
inline constexpr double kAlone = 1e-9;

// From so many coordinates on the matrices of many channels, which meet in the few columns of the shape only, are mostly
// zeros: their products with a vector took half of a fit with 800 channels.
inline constexpr Eigen::Index kLeastSparse = 200;

// Sums over the samples of one cluster, in whitened coordinates (bread.h).
struct Cluster {
  // Of no samples.
  explicit Cluster(const FreedomTally& freedom);
  void Add(const Cluster& other);

  Eigen::MatrixXd curvature;  // m x m: the cluster's part of the second derivatives, which add up to the unit matrix
  Eigen::VectorXd score;      // m: its part of the gradient
  // m x m, lower half: sum of a a^T, with a what the solution moves by without a sample (sandwich.h). Empty without
  // FreedomTally::exact: hundreds of channels have no room for one more matrix a cluster.
  Eigen::MatrixXd scatter;
  Eigen::ArrayXd squares, fourths;  // a number each: sums of FreedomTally::Squares and of their squares
};

// (1 - curvature)^(-1/2) times the columns of `vectors`. Directions that the cluster alone determines (curvature above
// 1 - 1e-9) are left out: it has no residual there. `curvature`: symmetric, below 1 but for rounding.
Eigen::MatrixXd InverseRootTimes(const Eigen::MatrixXd& curvature, const Eigen::MatrixXd& vectors);

// The rows as columns of length 1. One of zeros, such as that of a number at its bound, stays one: NaN in all of it would
// make a fit with 800 channels twice as long.
Eigen::MatrixXd UnitColumns(const Eigen::MatrixXd& rows);

// CR2 [Bell and McCaffrey 2002]: the filling is the sum of a a^T with a = (1 - curvature)^(-1/2) score, which has no
// bias where residuals are independent and of one variance.
class ClusterTally {
 public:
  // As FreedomTally.
  ClusterTally(const Eigen::MatrixXd& numbers, std::size_t clusters, double residual_variance);

  void Add(const Cluster& cluster);
  // The scatter of samples whose clusters hold none.
  void AddScatter(const ProductSums& of_samples);
  // Adds what another tally of the same fit has; the order is that of the clusters.
  void Merge(const ClusterTally& other);

  // Lower halves; empty where nothing was added.
  const Eigen::MatrixXd& filling() const { return filling_; }
  const Eigen::MatrixXd& scatter() const { return scatter_; }
  const FreedomTally& freedom() const { return freedom_; }

 private:
  // Of many channels a matrix that waits for its first cluster would take 21 MB.
  void MakeRoom(Eigen::MatrixXd* matrix) const;

  Eigen::MatrixXd filling_, scatter_;
  FreedomTally freedom_;
};

}  // namespace lobefit
