// The bread of the sandwich covariance: the matrix A of second derivatives of the cost, factored as A^-1 = W W^T, and
// the directions in which it is flat.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/errors/whitened_matrix.h"
#include "lobefit/fit/objective/problem.h"

namespace lobefit {

// A = sum over samples of rho' J^T J + 2 rho'' (J^T r)(J^T r)^T: Gauss and Newton's matrix to second order in the loss.
// Second derivatives of the model times residuals are left out.
//
// A is an arrow: coordinates of one channel (its F0, its albedo) meet those of another only through the rest, the
// border. W has the same form, so that a sample's row of one channel has entries for the border and for that channel
// alone, and a fit of many channels costs no more a channel than one of few. A loss takes all channels of a sample
// together, and so does a gain: then all is border. Gains are taken out of A as out of the step (gains.h).
struct Bread {
  WhitenedForm form;     // of the columns of W
  SparseRows whitening;  // W, coordinates x columns; rows of held coordinates are 0
  // [channel]: a row of the kernel's columns without the residual (KernelModel), times this, is the row times W: the
  // border's entries, then the channel's own.
  std::vector<Eigen::MatrixXd> whiten_row;
  // Of gains, W^T h / d (GainLink): a sample's row less its gain's column times this is what the sample says of the
  // coordinates when the gain follows them. The prior of a gain is one more row, its column the root of the precision.
  std::vector<Eigen::VectorXd> lean;  // [gain]
  // W^T P W of priors that stand for observations: what they add to the filling, whose unit is a residual's variance.
  // Of the border's numbers, which are all that such priors are of; both empty where there is none.
  Eigen::MatrixXd prior_of_gains, prior_of_coordinates;
  double residual_variance = 0;  // mean square of the weighed residuals
  std::vector<bool> at_bound;    // [coordinate] held at a bound: the cost would go on falling beyond it
  // [coordinate] has a part in a direction that is flat: it has no error.
  std::vector<bool> undetermined;
  std::vector<std::string> degenerate;  // the flat directions, in words
};

// `most_full`: from more coordinates on not all pairs are kept (WhitenedForm).
Bread FactorBread(const Problem& problem, const Layout& layout, const std::vector<double>& u, ThreadPool* pool,
                  std::size_t most_full = kMostFull);

}  // namespace lobefit
