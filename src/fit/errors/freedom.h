// Degrees of freedom of the variances that a sandwich gives: how many samples or clusters decide a number.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "lobefit/fit/errors/sample_rows.h"
#include "lobefit/fit/errors/whitened_matrix.h"

namespace lobefit {

struct Cluster;

// From so many coordinates on, numbers of many channels are mostly zeros.
inline constexpr Eigen::Index kLeastSparse = 200;

using SparseColumns = Eigen::SparseMatrix<double>;

// The estimated variance of a number z^T a of the whitened coordinates (bread.h) is taken as a multiple of the
// chi-square with its mean and variance [Satterthwaite 1946]: 2 mean^2 / variance degrees of freedom, with the noise of
// each sample as its own residual shows it. Noise of one variance alone made the intervals of a metric in which the
// highlight decides too short: those of `ngan` from 8 incidences with a drift held alpha_x in 91.8 % of 1000.
//
// Of independent samples, whose variance is the sum of w = (z^T a)^2, each with one residual: of normal residuals w has
// the mean v and w^2 the mean 3 v^2, so that (sum v)^2 / sum v^2 is estimated by 3 (sum w)^2 / sum w^2, the number of
// samples where all count alike. Several channels of a sample are taken as one.
//
// Of clusters, CR2 (clusters.h) as Bell and McCaffrey [2002], with the square of the trace over the trace of the square
// as in Imbens and Kolesar [2016]: cluster g's part is (y_g^T s_g - b_g^T s)^2 with s_g its own score and s that of
// all, y_g = (1 - curvature_g)^(-1/2) z and b_g = curvature_g y_g, and the covariance of two parts is
//   V_gk = [g = k] y_g^T S_g y_g - b_k^T S_g y_g - b_g^T S_k y_k + b_g^T S b_k,
// S_g the cluster's scatter, S that of all. G equal clusters have G - 1 degrees of freedom. V_gg^2 is lessened by two
// thirds of its samples' w^2, by which the square of an estimated scatter is too large; more than G are never had.
class FreedomTally {
 public:
  // `numbers`: m x numbers, z each, of length 1 or 0; kept by reference, as the form. `clusters`: how many will be
  // added. `residual_variance`: the unit of squares, so that their squares are numbers whatever that of the values.
  FreedomTally(const WhitenedForm& form, const SparseColumns& numbers, std::size_t clusters, double residual_variance);

  void Add(const Cluster& cluster);
  // Adds what another tally of the same fit has; the order is that of the clusters.
  void Merge(const FreedomTally& other);

  const WhitenedForm& form() const { return *form_; }
  const SparseColumns& numbers() const { return *numbers_; }
  // Whether degrees of freedom of clusters are exact, which takes each one's scatter, and all of it.
  bool exact() const { return exact_; }
  // (z^T a)^2 of samples a (samples x m, at most kPiece), samples x numbers, in the unit.
  Eigen::ArrayXXd Squares(const Eigen::MatrixXd& a) const;

  // A number each; infinite where no sample has a part in it.
  Eigen::VectorXd OfSamples() const;
  // A number each; NaN where no cluster has a part in it. `scatter`: that of all. Up to 100 clusters exactly;
  // of more, where it decides nothing, with each cluster's curvature taken as a multiple of the unit matrix and with
  // the part of noise of one variance in what two clusters share.
  Eigen::VectorXd OfClusters(const WhitenedMatrix& scatter) const;

 private:
  Eigen::ArrayXd Exact(const WhitenedMatrix& scatter) const;
  Eigen::ArrayXd Lengths() const;

  const WhitenedForm* form_;
  const SparseColumns* numbers_;
  std::size_t clusters_;
  bool exact_;
  double per_unit_;
  RowMajorMatrix dense_;              // `numbers` where few channels leave little of it zero
  Eigen::ArrayXd squares_, fourths_;  // sums over samples of w and w^2
  // With h = z^T curvature z the cluster's share in the variance of a number under noise of one variance, sums of h,
  // and without `exact_` of e = h^2 / (1 - h) and e^2, with h as a part of z^T z.
  Eigen::ArrayXd h_, e_, e2_;
  Eigen::ArrayXd squares_2_;  // without `exact_`: sum over clusters of the square of its w
  struct Influence {
    Eigen::MatrixXd b, scattered;     // b_g and S_g y_g, m x numbers, in the unit
    Eigen::ArrayXd own;               // y_g^T S_g y_g, likewise
    Eigen::ArrayXd squares, fourths;  // the cluster's
  };
  std::vector<Influence> influence_;  // for `exact_`
};

}  // namespace lobefit
