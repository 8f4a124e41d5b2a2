// The trials of a validation: make a measurement from known parameters, fit it, keep what came out beside what was
// true.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/fit/fit.h"
#include "lobefit/synthesis/synthesis.h"
#include "lobefit/validate/truth.h"

namespace lobefit {

struct Experiment {
  Truth truth;
  // Set: every trial draws a material of the truth's kind from it.
  std::optional<MaterialRange> range;
  DirectionList directions;
  bool isotropic = false;  // the layout cannot express a dependence on azimuth
  // Every measurement is made a second time with the sample turned by 180 degrees on its stage, where it stands crooked
  // as before: two files of one fit.
  bool turned = false;
  Noise noise;
  Recipe recipe;  // what is fitted
  FitOptions fit;
  std::uint64_t seed = 1;
};

// Numbers are in outside units, one an entry of Entries(recipe.model, channels).
struct Trial {
  bool done = false;          // false: not run, the validation was interrupted
  std::string error;          // not empty: the fit refused the measurement
  std::vector<double> truth;  // NaN for entries that the truth's model does not have
  std::vector<double> value, standard_error, standard_error_clustered, freedom;
  std::vector<double> independent_freedom;  // of standard_error
  std::vector<bool> free, at_bound;
  bool converged = false, determined = false;
  std::vector<std::string> degenerate;
  double cost = 0;
  // Cost of the true parameters on the same samples; NaN where the fitted model is not the truth's, or the fit chose
  // its metric or noise itself.
  double cost_at_truth = 0;
  double difference = 0;  // largest relative one of the fitted parameters from the true ones; NaN as above
  std::size_t minima = 0, samples = 0, incidences = 0;
  bool misfit = false;  // flagged
  bool biased = false;  // the fit says that its metric is biased by the noise
  double seconds = 0;
};

// True where recipe and truth are the same model, so that parameters can be compared one by one.
bool IsSameModel(const Model& a, const Model& b);

// Trial `index` of `experiment`: depends on both and nothing else.
Trial RunTrial(const Experiment& experiment, std::size_t index);

// A measurement (synthetic, with known truth) fitted and compared.
Trial CompareWithTruth(const Experiment& experiment, const Truth& truth, Measurement measurement);

// The trials of `indices`, one fit a thread. `done` is called after each, from any thread; once `stop` is set no
// further trial begins.
void RunTrials(const Experiment& experiment, const std::vector<std::size_t>& indices, int threads,
               const std::function<void(std::size_t index, Trial trial)>& done, const std::atomic<bool>& stop);
// Trials [0, count); those that were not run come back as not done. `advance` may be empty.
std::vector<Trial> RunTrials(const Experiment& experiment, std::size_t count, int threads,
                             const std::function<void()>& advance, const std::atomic<bool>& stop);

}  // namespace lobefit
