// Descent of an objective of many samples by means of a subsample's, which stands in for it.
#pragma once

#include "lobefit/fit/search/descent.h"

namespace lobefit {

// Rounds of one pass over `whole`: the cost of `part` times `scale`, given the value, gradient and J^T J that the whole
// has at the point, is descended; where it ends is the next point. What a round leaves of the gradient is only the
// share by which the second derivatives differ that J^T J leaves out, where a Gauss-Newton step leaves all of those: 40
// to 65 % of the gradient where residuals stay large. Full tables of 909 696 samples take 2 rounds (62 coordinates,
// nickel) or 3 (75, a metallic paint; 76, marble), where steps took 5, 8 and 18 passes. Lobes that may tilt have kinks,
// where steps took over a hundred.
//
// `scale`: samples of the whole over those of the part. Both have the same box; their `evaluate` is used, not the
// arrow. Ends where a round gains no more than options.function_tolerance of the cost, or 3e-6 of it at what is a
// minimum (IsMinimum), where damping no longer helps, or after options.max_iterations rounds, which Descent::iterations
// counts; `converged` is asked of the whole.
Descent DescendByStandIn(const BoundedObjective& whole, const BoundedObjective& part, double scale,
                         const Eigen::VectorXd& start, const DescentOptions& options);

}  // namespace lobefit
