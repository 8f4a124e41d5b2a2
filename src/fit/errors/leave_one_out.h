// What a solution moves by when one sample is left out, for pieces of samples at a time.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "lobefit/fit/errors/bread.h"
#include "lobefit/fit/errors/sample_rows.h"

namespace lobefit {

// A piece of samples in whitened coordinates (bread.h).
struct WhitenedPiece {
  // [channel] samples x (border + own), padded with rows of zeros to a multiple of 8 samples.
  std::vector<Eigen::MatrixXd> rows;
  SampleRows samples;

  Eigen::Index count() const { return samples.curvature.size(); }
};

class LeaveOneOut {
 public:
  // Keeps a reference.
  explicit LeaveOneOut(const Bread& bread) : bread_(bread) {}

  // Of each sample a = (1 - its part of the curvature)^-1 times its gradient: padded samples x m.
  //
  // With k and o the border's and the own entries of a channel's row, the curvature of a sample is the sum over
  // channels of (k, o)^T (k, o) and c q q^T with q the sum of k r. Its own part is inverted channel by channel; what is
  // left is the border's,
  //   (1 - sum of w k k^T - c q q^T) y = sum of w r k,   w = 1 / (1 - o.o),   and a_own = w (r + k.y) o,
  // whose series all samples of the piece take together; those that decide much of the fit are solved for one by one.
  const Eigen::MatrixXd& Evaluate(const WhitenedPiece& piece);

 private:
  void Prepare(const WhitenedPiece& piece);
  void AddSeries(const WhitenedPiece& piece);
  Eigen::VectorXd Direct(const WhitenedPiece& piece, Eigen::Index i) const;

  const Bread& bread_;
  // Padded samples x 1, border or channels.
  Eigen::ArrayXd size_, sum_;
  Eigen::MatrixXd residuals_, w_, y_, q_, term_, next_, moves_;
};

}  // namespace lobefit
