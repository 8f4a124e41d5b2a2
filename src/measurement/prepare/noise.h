// Instrument noise: stated uncertainties, a noise floor, noise that was rectified.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// States the standard deviation of f_r of each sample. What was stated before is another source of noise: the variances
// add. Domain: one finite sigma >= 0 a sample.
void AddSigma(const std::vector<double>& sigma, Samples* samples);

// The same for an instrument whose reading, f_r cos(theta_i), has the constant standard deviation `floor`
// (--noise-floor).
void AddNoiseFloor(double floor, Samples* samples);

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
