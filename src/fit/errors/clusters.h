// The sandwich's filling from clusters of samples that may depend on each other, with the correction for how far the
// fit bends towards each cluster.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "lobefit/fit/errors/freedom.h"
#include "lobefit/fit/errors/whitened_matrix.h"

namespace lobefit {

// A direction in which a sample's part of the curvature is this near to all of it has no residual but that sample's,
// which is zero there.
inline constexpr double kAlone = 1e-9;

// Sums over the samples of one cluster, in whitened coordinates (bread.h).
struct Cluster {
  // Of no samples.
  explicit Cluster(const FreedomTally& freedom);
  void Add(const Cluster& other);

  WhitenedMatrix curvature;  // the cluster's part of the second derivatives, which add up to the unit matrix
  Eigen::VectorXd score;     // m: its part of the gradient
  // Sum of a a^T, with a what the solution moves by without a sample (sandwich.h). Empty without FreedomTally::exact.
  WhitenedMatrix scatter;
  Eigen::ArrayXd squares, fourths;  // a number each: sums of FreedomTally::Squares and of their squares
};

// (1 - curvature)^(-1/2) times the columns of `vectors`. Directions that the cluster alone determines (curvature above
// 1 - 1e-9) are left out: it has no residual there. `curvature`: symmetric, below 1 but for rounding.
Eigen::MatrixXd InverseRootTimes(const WhitenedMatrix& curvature, const Eigen::MatrixXd& vectors);

// CR2 [Bell and McCaffrey 2002]: the filling is the sum of a a^T with a = (1 - curvature)^(-1/2) score, which has no
// bias where residuals are independent and of one variance.
class ClusterTally {
 public:
  // As FreedomTally.
  ClusterTally(const WhitenedForm& form, const SparseColumns& numbers, std::size_t clusters, double residual_variance);

  void Add(const Cluster& cluster);
  // The scatter of the samples of a piece, whose clusters hold none. `sums` is room.
  void AddScatter(const Eigen::MatrixXd& moves, Eigen::Index count, ProductSums* sums);
  // Adds what another tally of the same fit has; the order is that of the clusters.
  void Merge(const ClusterTally& other);

  const WhitenedMatrix& filling() const { return filling_; }
  const WhitenedMatrix& scatter() const { return scatter_; }
  const FreedomTally& freedom() const { return freedom_; }

 private:
  WhitenedMatrix filling_, scatter_;
  FreedomTally freedom_;
};

}  // namespace lobefit
