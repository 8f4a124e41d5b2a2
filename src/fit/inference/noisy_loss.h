// What noise that is not even about its mean makes of a robust loss, whose estimate is no mean.
#pragma once

#include <vector>

#include "lobefit/fit/metric/loss.h"
#include "lobefit/fit/metric/metric.h"

namespace lobefit {

// Of one channel of a sample, means over the noise of its reading. s is the slope of the residual by the model there
// over that where the reading is the model's value: 1 but for metrics that divide by the reading.
struct MeanScore {
  double score = 0;      // of rho' r s: what the gradient of the cost has there in the mean, 0 where it is unbiased
  double curvature = 0;  // of (rho' + 2 rho'' r^2) s^2
};

// Readings m = v + noise with noise as NoiseModel has it, counts Poisson distributed and the rest normal, have
// residuals r = root (T(v) - T(m)) (Residuals, transform.h). A fit with a loss is unbiased where the mean of rho' r s
// is 0 [Cantoni and Ronchetti 2001, whose correction of the score it is, told here and not taken out]. By quadrature:
// counts up to 30 by their probabilities, more by a normal number with their skewness (Cornish and Fisher's first
// term). The squares of the other channels enter rho by their means.
class NoisyLoss {
 public:
  // Domain: scale > 0, loss not kNone.
  NoisyLoss(const Transform& transform, Loss loss, double scale, const NoiseModel& noise)
      : transform_(transform), loss_(loss), scale_(scale), noise_(noise) {}

  // v[channel] = f_r cos_theta_i of the model, root the square root of the sample's weight.
  std::vector<MeanScore> Evaluate(const std::vector<double>& v, double root) const;

 private:
  // Residuals that a channel may have, their slopes s and their probabilities, whose sum is 1.
  struct Spread {
    std::vector<double> residual, slope, probability;
    double mean_square = 0;
  };
  Spread Residuals(double v, double root) const;

  Transform transform_;
  Loss loss_;
  double scale_;
  NoiseModel noise_;
};

}  // namespace lobefit
