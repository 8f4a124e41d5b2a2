// Small systems with held unknowns, against Eigen's.
#include "lobefit/maps/engine/factor.h"

#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

using Held = std::array<bool, kMostUnknowns>;

// A random positive definite matrix whose scales differ by `decades`.
Eigen::MatrixXd Definite(int n, double decades, std::mt19937* engine) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd a(n, n + 2);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n + 2; ++j) a(i, j) = normal(*engine);
    a.row(i) *= std::pow(10, decades * normal(*engine));
  }
  return a * a.transpose();
}

// Only what Factorise says that it reads: from the diagonal up.
MapMatrix UpperOf(const Eigen::MatrixXd& m) {
  MapMatrix matrix;
  for (auto& row : matrix) row.fill(std::nan(""));
  for (int i = 0; i < m.rows(); ++i) {
    for (int j = i; j < m.cols(); ++j) matrix[i][j] = m(i, j);
  }
  return matrix;
}

class Systems : public testing::TestWithParam<int> {};

TEST_P(Systems, AreSolvedAndInvertedWithHeldUnknowns) {
  const int n = GetParam();
  std::mt19937 engine(static_cast<unsigned>(n));
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::MatrixXd m = Definite(n, trial % 2 == 0 ? 0 : 2, &engine);
    Held held = {};
    std::vector<int> open;
    for (int i = 0; i < n; ++i) {
      held[i] = trial > 4 && engine() % 3 == 0;
      if (!held[i]) open.push_back(i);
    }
    MapMatrix factor = UpperOf(m);
    ASSERT_TRUE(Factorise(n, held, &factor));
    const auto count = static_cast<Eigen::Index>(open.size());
    Eigen::MatrixXd part(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index j = 0; j < count; ++j) part(i, j) = m(open[i], open[j]);
    }
    const Eigen::MatrixXd expected = part.inverse();
    const MapMatrix inverse = InverseOf(n, held, factor);
    Eigen::VectorXd right(count);
    MapVector x = {};
    for (Eigen::Index i = 0; i < count; ++i) x[open[i]] = right(i) = std::sin(3.0 * static_cast<double>(i) + trial);
    const Eigen::VectorXd solution = expected * right;
    SolveFactorised(n, factor, &x);
    for (Eigen::Index i = 0; i < count; ++i) {
      const double size = std::sqrt(expected(i, i) * (right.transpose() * expected * right)(0));
      EXPECT_NEAR(x[open[i]], solution(i), 1e-8 * size);
      for (Eigen::Index j = 0; j < count; ++j) {
        EXPECT_NEAR(inverse[open[i]][open[j]], expected(i, j), 1e-8 * std::sqrt(expected(i, i) * expected(j, j)));
      }
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        if (held[i] || held[j]) {
          EXPECT_EQ(inverse[i][j], 0);
        }
      }
    }
  }
}

TEST_P(Systems, WithoutASolutionAreRefused) {
  const int n = GetParam();
  std::mt19937 engine(7);
  const Eigen::MatrixXd m = Definite(n, 0, &engine);
  const Held free = {};
  MapMatrix zero = UpperOf(0 * m), negative = UpperOf(-m), nothing = UpperOf(m * std::nan(""));
  EXPECT_FALSE(Factorise(n, free, &zero));
  EXPECT_FALSE(Factorise(n, free, &negative));
  EXPECT_FALSE(Factorise(n, free, &nothing));
  if (n == 1) return;
  // Two unknowns that do the same; with one of them held there is a solution.
  Eigen::MatrixXd same = m;
  same.row(n - 1) = same.row(0);
  same.col(n - 1) = same.col(0);
  same(n - 1, n - 1) = same(0, 0);
  MapMatrix twins = UpperOf(same), parted = twins;
  EXPECT_FALSE(Factorise(n, free, &twins));
  Held last = {};
  last[n - 1] = true;
  EXPECT_TRUE(Factorise(n, last, &parted));
}

INSTANTIATE_TEST_SUITE_P(Sizes, Systems, testing::Range(1, kMostUnknowns + 1));

}  // namespace
}  // namespace lobefit
