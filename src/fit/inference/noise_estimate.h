// The noise of the readings, estimated from what a fit leaves.
#pragma once

#include <optional>
#include <vector>

#include "lobefit/fit/metric/metric.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// From differences of neighbouring residuals r = (m - f) cos_theta_i, which a lobe's curvature, a gain of the incidence
// and smooth misfit do not enter:
//   e_j = (r_j - sum a_n r_n) / sqrt(1 + sum a_n^2),  x_j = sqrt((v_j^2 + sum a_n^2 v_n^2) / (1 + sum a_n^2))
// over the 6 nearest directions of the same incidence, a the weights of the local linear prediction at j in its tangent
// plane. In bins of equal count in x the deviation is 1.4826 median |e|; floor and relative noise fit it as
// sqrt(floor^2 + relative^2 x^2), by the logarithms with Huber's loss, and with a term of counting noise, poisson times
// the mean of v weighted alike, where that halves what they leave and gains more than 3 standard deviations. A sixth to
// a quarter of a misfit of 10 % remains in `relative` where samples are 15 degrees apart.
//
// Where 50 directions or more were read twice in one file, the differences of the two readings are taken in place of
// those: no misfit enters them. A file's rows that are copies of each other are no readings.
//
// f_r[channel][sample] of the model. Nothing where fewer than 40 samples have neighbours, or nothing but rounding is
// left. At most some 4000 samples are looked at, spread over the incidences.
std::optional<NoiseModel> EstimateNoise(const Samples& samples, const Incidences& incidences,
                                        const std::vector<std::vector<double>>& f_r);

// Whole incidences with neighbours, spread over all, of some 40 000 samples at most: enough for the estimate. Empty
// where no incidence has more than 6.
struct NoiseSubset {
  Samples samples;
  Incidences incidences;
};
NoiseSubset SubsetForNoise(const Samples& samples, const Incidences& incidences);

}  // namespace lobefit
