#include "lobefit/fit/inference/times_inverse.h"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

// Channels of two own coordinates, among which those of the border stand first and last.
ArrowMatrix ArrowOf(std::size_t channels) {
  ArrowShape shape = {{0, static_cast<int>(2 * channels) + 1}, {}};
  for (std::size_t c = 0; c < channels; ++c)
    shape.own.push_back({1 + 2 * static_cast<int>(c), 2 + 2 * static_cast<int>(c)});
  ArrowMatrix arrow(shape);
  arrow.border << 40, 3, 3, 50;
  for (std::size_t c = 0; c < channels; ++c) {
    const auto x = static_cast<double>(c);
    arrow.across[c] << 0.3 * std::sin(x), 0.2, -0.1, 0.4 * std::cos(x);
    arrow.own[c] << 2 + std::sin(x), 0.5, 0.5, 1;
  }
  return arrow;
}

// By eigenvectors and, of many coordinates, by a factorisation that keeps the zeros.
TEST(TimesInverse, IsThatOfTheWholeMatrix) {
  for (const std::size_t channels : {3U, 150U}) {
    const ArrowMatrix arrow = ArrowOf(channels);
    const Eigen::MatrixXd dense = arrow.Dense();
    Eigen::MatrixXd rows(2, dense.cols());
    for (Eigen::Index j = 0; j < rows.cols(); ++j) rows.col(j) << std::cos(static_cast<double>(j)), 1;
    const Eigen::MatrixXd expected = rows * dense.inverse();
    // The hair of curvature is 1e-10.
    EXPECT_LT((TimesInverse(rows, arrow) - expected).norm(), 1e-8 * expected.norm()) << channels;
  }
}

// A coordinate that nothing depends on is left out.
TEST(TimesInverse, LeavesOutWhatIsNotDetermined) {
  ArrowMatrix arrow = ArrowOf(3);
  arrow.own[1].setZero();
  arrow.across[1].setZero();
  const Eigen::MatrixXd product = TimesInverse(Eigen::MatrixXd::Ones(1, 8), arrow);
  EXPECT_NEAR(product(0, 3), 0, 1e-12);
  EXPECT_NEAR(product(0, 4), 0, 1e-12);
  EXPECT_GT(std::fabs(product(0, 5)), 0.01);
}

}  // namespace
}  // namespace lobefit
