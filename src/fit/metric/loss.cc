#include "lobefit/fit/metric/loss.h"

#include <algorithm>
#include <cmath>

namespace lobefit {

const std::vector<Choice<Loss>>& LossChoices() {
  static const std::vector<Choice<Loss>> choices = {
      {Loss::kNone, "none", "squares"},
      {Loss::kHuber, "huber", "linear beyond the scale"},
      {Loss::kCauchy, "cauchy", "logarithmic beyond the scale"},
      {Loss::kTukey, "tukey", "constant beyond the scale"},
  };
  return choices;
}

LossValue EvaluateLoss(Loss loss, double scale, double s) {
  const double a2 = scale * scale;
  switch (loss) {
    case Loss::kHuber: {
      if (s <= a2) break;
      const double r = std::sqrt(s);
      return {2 * scale * r - a2, scale / r, -0.5 * scale / (r * s)};
    }
    case Loss::kCauchy: {
      const double first = 1 / (1 + s / a2);
      return {a2 * std::log1p(s / a2), first, -first * first / a2};
    }
    case Loss::kTukey: {
      const double t = s < a2 ? 1 - s / a2 : 0;
      return {a2 / 3 * (1 - t * t * t), t * t, -2 * t / a2};
    }
    case Loss::kNone:
      break;
  }
  return {s, 1, 0};
}

double RobustDeviation(std::vector<double>* residuals) {
  if (residuals->empty()) return 0;
  for (double& r : *residuals) r = std::fabs(r);
  const auto middle = residuals->begin() + static_cast<std::ptrdiff_t>(residuals->size() / 2);
  std::nth_element(residuals->begin(), middle, residuals->end());
  return 1.4826 * *middle;
}

}  // namespace lobefit
