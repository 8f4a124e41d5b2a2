// Covariances of the reported entries.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "lobefit/fit/errors/entries.h"
#include "lobefit/fit/errors/whitened_matrix.h"

namespace lobefit {

// Where the filling is not full (WhitenedForm), variances of all entries and the covariances of those that are of no
// channel.
class EntryCovariance {
 public:
  EntryCovariance() = default;
  // rows filling rows^T; NaN for entries without an error.
  EntryCovariance(const ReportedEntries& entries, const WhitenedMatrix& filling, bool full);

  Eigen::Index size() const { return variance_.size(); }
  bool full() const { return full_; }
  double Variance(Eigen::Index i) const { return variance_(i); }
  // NaN for a pair that is not kept.
  double operator()(Eigen::Index i, Eigen::Index j) const;
  // Adds moved moved^T where both entries have an error: what is fixed stays so.
  void AddSquare(const Eigen::VectorXd& moved);

 private:
  bool full_ = true;
  Eigen::VectorXd variance_;
  std::vector<Eigen::Index> kept_;  // [entry] its row of `matrix_`, or -1
  Eigen::MatrixXd matrix_;
};

}  // namespace lobefit
