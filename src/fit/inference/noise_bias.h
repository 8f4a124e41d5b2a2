// What the noise of the readings does to a fit through the curve of its metric and through its loss.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/errors/uncertainty.h"
#include "lobefit/fit/inference/noise_estimate.h"
#include "lobefit/fit/objective/problem.h"

namespace lobefit {

struct NoiseBias {
  NoiseModel noise;
  double negative = 0;    // share of the readings below 0
  double near_floor = 0;  // share of the model's values below 3 standard deviations of floor and counts
  // Largest predicted bias of a reported parameter, in its standard errors, and which one it is.
  struct Largest {
    double errors = 0;
    std::string parameter;
  };
  Largest of_floor;       // by the floor and counting noise alone
  Largest of_all;         // by all noise
  Eigen::VectorXd moved;  // how far all noise moves the solver's coordinates
};

// To first order noise of standard deviation s moves the mean of a transformed reading by T''(v) s^2 / 2, and the
// parameters by d = (J^T J)^-1 J^T (T'' s^2 / 2). What noise of the value does is the same share of every value,
// rho^2 / 3 under the cube root: no reason for another curve, so that the floor's part is told apart, but more than a
// standard error where samples are many. Good while v > 2 s: below, v is taken as 2 s. With a loss what moves them is
// the mean of its score (noisy_loss.h), which is not 0 where the noise of a residual is skewed, whatever the metric;
// outliers that are more often too high than too low are not in it. `uncertainty` is that before any bias was added.
// Nothing where the noise cannot be estimated.
std::optional<NoiseBias> PredictNoiseBias(const Layout& layout, const std::vector<double>& u,
                                          const Uncertainty& uncertainty, const Samples& samples,
                                          const Incidences& incidences, ThreadPool* pool);

// The covariances of the reported entries with the squares of what the noise moves them by: mean square errors about
// the truth, so that intervals hold it where the metric is biased by less than some standard errors.
void AddBias(const NoiseBias& bias, const Layout& layout, const std::vector<double>& u, Uncertainty* uncertainty);

// Whether Metric::kAsinh should take the place of an automatic metric: more than 0.1 % of the readings are negative,
// more than 5 % of the model's values lie below 3 standard deviations of floor and counts, or these bias a parameter by
// more than half of its standard error.
bool WantsAsinh(const NoiseBias& bias);

// The noise with which kAsinh is fitted: at least 2 % of the value, for a smaller knee would give the highlight to the
// tails.
NoiseModel NoiseForAsinh(const NoiseModel& estimated);
// Whether two such differ by less than a tenth, which moves no parameter.
bool IsNear(const NoiseModel& a, const NoiseModel& b);

// "6.5 % of the readings are negative (noise floor 0.01/sr, noise 5 % of the value): fitted with metric asinh, knee
// 0.2/sr; cube-root would be ..."
std::string ToSwitchRemark(const NoiseBias& bias, Metric before);
// For a metric that the user gave, or a loss; empty where it is biased by no more than half a standard error.
std::string ToBiasRemark(const NoiseBias& bias, Metric metric, Loss loss);
// Whether a remark is one of ToBiasRemark.
bool IsBiasRemark(const std::string& remark);

}  // namespace lobefit
