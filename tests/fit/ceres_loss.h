// Ceres' own loss functions, against which ours are tested.
#pragma once

#include <memory>

#include <ceres/loss_function.h>

#include "lobefit/fit/metric/loss.h"

namespace lobefit {

inline std::unique_ptr<ceres::LossFunction> CeresLoss(Loss loss, double scale) {
  switch (loss) {
    case Loss::kHuber:
      return std::make_unique<ceres::HuberLoss>(scale);
    case Loss::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(scale);
    case Loss::kTukey:
      return std::make_unique<ceres::TukeyLoss>(scale);
    case Loss::kNone:
      break;
  }
  return std::make_unique<ceres::TrivialLoss>();
}

}  // namespace lobefit
