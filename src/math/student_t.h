// Student's t distribution: how many standard errors an interval must span where the error itself was estimated.
#pragma once

namespace lobefit {

// Probability that t of `freedom` degrees of freedom (> 0, not necessarily whole) is below x. Absolute error below
// 1e-13.
double StudentTCdf(double x, double freedom);

// x with StudentTCdf(x, freedom) = probability, in (0, 1). An infinite `freedom` is the normal distribution.
double StudentTQuantile(double probability, double freedom);

}  // namespace lobefit
