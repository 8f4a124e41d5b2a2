// Weights from stated uncertainties and from counting noise, for the metric that is fitted.
#pragma once

#include <vector>

#include "lobefit/fit/metric/metric.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// The delta method: a reading v = f_r cos_theta_i of standard deviation s has a residual of variance (T'(v) s)^2. v is
// the model's value, since weights taken at the reading favour those that fell low: f0 then comes out 1.5 to 2.3
// standard errors too low at 5 % noise. To each variance the median one (at the readings) is added, for beyond that the
// model's misfit and not the instrument limits a sample; so no sample weighs more than twice the middle one.
class SigmaWeights {
 public:
  // Of metrics that know the noise (kAsinh): `noise.relative` and `noise.poisson` are added to the stated uncertainty,
  // and with counting noise, which the curve does not level, there are weights without one. `samples` must outlive the
  // object.
  SigmaWeights(const Samples& samples, Metric metric, const NoiseModel& noise);

  // Of nothing to weigh by: no uncertainty is stated, or all are 0.
  bool empty() const { return !(median_ > 0); }
  // values[channel][sample - begin], f_r, of which the mean over the channels counts.
  std::vector<double> At(const std::vector<std::vector<double>>& values, std::size_t begin) const;
  // At the readings, for what has no model yet.
  std::vector<double> AtReadings() const { return At(samples_.values, 0); }

 private:
  std::vector<double> Variances(const std::vector<std::vector<double>>& values, std::size_t begin) const;

  const Samples& samples_;
  Transform transform_;
  NoiseModel noise_;  // what is not stated
  double median_ = 0;
};

}  // namespace lobefit
