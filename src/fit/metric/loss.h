// Robust losses: what the squared residual of a sample, over all its channels, counts.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/base/choice.h"

namespace lobefit {

// With s the squared residual and a the scale, in units of the residual [Ceres Solver's definitions]:
//   kHuber   s up to a^2, then 2 a sqrt(s) - a^2
//   kCauchy  a^2 ln(1 + s / a^2)
//   kTukey   a^2 / 3 (1 - (1 - s / a^2)^3) up to a^2, then a^2 / 3
enum class Loss { kNone, kHuber, kCauchy, kTukey };

const std::vector<Choice<Loss>>& LossChoices();

struct LossValue {
  double rho, first, second;  // rho(s) and its derivatives by s
};

// Domain: s >= 0, scale > 0. kHuber's second derivative jumps at a^2, where it is that below.
LossValue EvaluateLoss(Loss loss, double scale, double s);

// 1.4826 times the median of |r|: the standard deviation of normal residuals about 0, moved little by outliers.
// Reorders the values; 0 where there are none.
double RobustDeviation(std::vector<double>* residuals);

}  // namespace lobefit
