#include "lobefit/fit/metric/loss.h"

#include <cmath>
#include <memory>
#include <random>

#include "tests/fit/ceres_loss.h"
#include <gtest/gtest.h>

namespace lobefit {
namespace {

// Catches Huber's - a^2 left out, one loss in place of another, a second derivative that is off.
TEST(EvaluateLoss, IsCeresToTheSecondDerivative) {
  for (const Choice<Loss>& choice : LossChoices()) {
    for (const double scale : {0.01, 0.3, 7.0}) {
      const auto ceres_loss = CeresLoss(choice.value, scale);
      for (const double share : {0.0, 1e-12, 0.1, 0.5, 0.999, 1.001, 2.0, 30.0, 1e6}) {
        const double s = share * scale * scale;
        double expected[3];
        ceres_loss->Evaluate(s, expected);
        const LossValue value = EvaluateLoss(choice.value, scale, s);
        // Ceres takes log(1 + x), which rounds x to 1.
        EXPECT_NEAR(value.rho, expected[0], 2e-15 * (expected[0] + s) + 3e-16 * scale * scale)
            << choice.name << " " << share;
        EXPECT_NEAR(value.first, expected[1], 1e-14 * expected[1]) << choice.name << " " << share;
        EXPECT_NEAR(value.second, expected[2], 1e-14 * std::fabs(expected[2])) << choice.name << " " << share;
      }
    }
  }
}

TEST(RobustDeviation, IsTheStandardDeviationWhateverTheOutliers) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, 0.3);
  std::vector<double> residuals(20001);
  for (double& r : residuals) r = normal(random);
  std::vector<double> with_outliers = residuals;
  for (std::size_t i = 0; i < 1000; ++i) with_outliers[i] = 1e9;
  EXPECT_NEAR(RobustDeviation(&residuals), 0.3, 0.01);
  EXPECT_NEAR(RobustDeviation(&with_outliers), 0.3, 0.03);
  residuals.clear();
  EXPECT_EQ(RobustDeviation(&residuals), 0);
}

}  // namespace
}  // namespace lobefit
