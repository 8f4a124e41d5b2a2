// Student's t distribution, of Boost.Math: how many standard errors an interval must span where the error itself was
// estimated.
#pragma once

namespace lobefit {

// Probability that t of `freedom` degrees of freedom (> 0, not necessarily whole; infinite: the normal distribution) is
// below x. Relative error of the smaller tail below 1e-12.
double StudentTCdf(double x, double freedom);

// x with StudentTCdf(x, freedom) = probability, in (0, 1); relative error below 1e-12.
double StudentTQuantile(double probability, double freedom);

}  // namespace lobefit
