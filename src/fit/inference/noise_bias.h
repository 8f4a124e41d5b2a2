// What the noise of the readings does to a fit through the curve of its metric.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "lobefit/fit/inference/noise_estimate.h"
#include "lobefit/fit/objective/coordinates.h"
#include "lobefit/fit/objective/problem.h"

namespace lobefit {

struct NoiseBias {
  NoiseModel noise;
  double negative = 0;    // share of the readings below 0
  double near_floor = 0;  // share of the model's values below 3 floors
  double errors = 0;      // largest predicted bias of a reported parameter, in its standard errors
  std::string parameter;  // which one
};

// To first order a noise floor s0 moves the mean of a transformed reading by T''(v) s0^2 / 2, and the parameters by
// d = (J^T J)^-1 J^T (T'' s0^2 / 2). (What noise of the value does is the same share of every value, rho^2 / 3 under the cube root: no
// reason for another curve, however many samples tell it from nothing.) Good while v > 2 s: below, v is taken as 2 s. `covariance` is that of
// the solver's coordinates. Nothing where the noise cannot be estimated.
std::optional<NoiseBias> PredictNoiseBias(const Layout& layout, const std::vector<double>& u,
                                          const Eigen::MatrixXd& covariance, const Samples& samples,
                                          const Incidences& incidences, ThreadPool* pool);

// Whether Metric::kAsinh should take the place of an automatic metric: more than 0.1 % of the readings are negative,
// more than 5 % of the model's values lie below 3 floors, or a parameter is biased by more than half of its standard
// error.
bool WantsAsinh(const NoiseBias& bias);

// The noise with which kAsinh is fitted: at least 2 % of the value, for a smaller knee would give the highlight to the
// tails.
NoiseModel NoiseForAsinh(const NoiseModel& estimated);
// Whether two such differ by less than a tenth, which moves no parameter.
bool IsNear(const NoiseModel& a, const NoiseModel& b);

// "6.5 % of the readings are negative (noise floor 0.01/sr, noise 5 % of the value): fitted with metric asinh, knee
// 0.2/sr; cube-root would be ..."
std::string ToSwitchRemark(const NoiseBias& bias, Metric before);
// For a metric that the user gave; empty where it is biased by no more than half a standard error.
std::string ToBiasRemark(const NoiseBias& bias, Metric metric);

}  // namespace lobefit
