// What the trials of an experiment say about a fit: bias, spread, and whether its intervals hold what they promise.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lobefit/validate/experiment.h"

namespace lobefit {

// A count among a total with its 95 % interval [Wilson 1927], which stays within [0, 1] and is right for small counts.
struct Share {
  std::size_t count = 0, total = 0;
  double value = 0, low = 0, high = 1;
};
// `sigmas`: half width of the interval in standard deviations.
Share ShareOf(std::size_t count, std::size_t total, double sigmas = 1.959963984540054);

// Intervals of one kind: value +- quantile * standard error.
struct IntervalCalibration {
  // Of (value - truth) / standard error, over the quantile at 95 % and times the normal distribution's.
  double z_mean = 0, z_sd = 0;
  Share within_68, within_95;
};

// Of the trials whose fit gave the entry a standard error.
struct EntryCalibration {
  Entry entry;
  std::size_t trials = 0;
  std::size_t not_determined = 0;  // the fit said so: no standard error, or held at a bound
  // More than 6 standard errors from the truth although the fit named an error (of Student's t as many as are as rare);
  // Gaussian errors are so far once in 5e8.
  std::size_t lost = 0;
  double bias = 0, bias_error = 0;  // mean of value - truth and its standard error, outside unit
  double spread = 0;                // standard deviation of value - truth
  double mean_error = 0;            // root mean square of the standard errors
  // With `stderr` and `stderr_clustered`, each with the fit's degrees of freedom: those of the first are infinite
  // unless a drift was estimated.
  IntervalCalibration independent, clustered;
};

struct Calibration {
  std::size_t planned = 0, done = 0;
  std::size_t refused = 0, not_converged = 0, not_determined = 0;
  // Cost above that of the true parameters: there is a better minimum that the search did not find.
  std::size_t wrong_minima = 0;
  // Of these, fits that gave no sign: converged, determined, no second minimum reported, no misfit flag.
  std::size_t wrong_unflagged = 0;
  Share misfit;  // fits whose misfit flag was raised: false alarms where the model is the truth's
  Share biased;  // fits that say that their metric is biased by the noise
  double seconds_median = 0, seconds_95 = 0;
  // The clustered intervals are the ones to judge: samples of an incidence are dependent.
  bool judge_clustered = false;
  std::vector<EntryCalibration> entries;  // the free ones that truth and fit share

  // In words: what fails; empty where all is well.
  std::vector<std::string> failures;
  bool passed() const { return failures.empty(); }
};

// What coverage and z must keep to. The bands are those of the project's own claim; a share or a spread fails where
// chance at its number of trials (1 in 1000 for one number) does not explain that it lies outside.
struct Limits {
  double coverage_low = 0.935, coverage_high = 0.965, z_sd_low = 0.95, z_sd_high = 1.05;
};
inline constexpr Limits kIndependentLimits = {};
// Few clusters make intervals by the sandwich less exact.
inline constexpr Limits kClusteredLimits = {0.90, 0.98, 0.8, 1.25};

Calibration Calibrate(const Experiment& experiment, const std::vector<Trial>& trials);

// One comparison: truth, value, error and how many standard errors they differ by.
std::string TrialToText(const Experiment& experiment, const Trial& trial);

// A table for people, without and with the verdict in words.
std::string TableOf(const Calibration& calibration);
std::string ToText(const Calibration& calibration);

}  // namespace lobefit
