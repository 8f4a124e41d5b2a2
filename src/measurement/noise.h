// Instrument noise: stated uncertainties as weights, a noise floor, noise that was rectified.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Sets the weights from `sigma`, the standard deviation of f_r of each sample: the inverse variance of ln(1 + f_r
// cos(theta_i)), the default metric's residual. The median variance is added to each, since beyond that the model's
// misfit and not the instrument limits a sample; so no sample weighs more than twice the middle one. The mean is 1.
// Weights that are there already are multiplied. Domain: one finite sigma >= 0 a sample.
void WeighBySigma(const std::vector<double>& sigma, Measurement* measurement);

// The same for an instrument whose reading, f_r cos(theta_i), has the constant standard deviation `floor`
// (--noise-floor).
void WeighByNoiseFloor(double floor, Measurement* measurement);

// Readings near the noise floor of which only the magnitude was kept.
struct RectifiedNoise {
  double floor = 0;               // standard deviation of the reading f_r cos(theta_i), 1/sr
  std::size_t samples_below = 0;  // samples below 3 floor
};

// Looks along scans (neighbouring rows of nearby directions) for stretches without a negative value whose scatter is as
// large as their mean: noise about zero would be negative half of the time. Of the first channel; nothing where there
// is no such stretch.
std::optional<RectifiedNoise> FindRectifiedNoise(const Measurement& measurement);

}  // namespace lobefit
