#include "lobefit/math/quadrature.h"

#include <limits>

#include <gtest/gtest.h>

#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

TEST(GaussLegendre, ExactToItsDegree) {
  for (const int n : {1, 2, 3, 8, 31, 64, 200}) {
    const QuadratureRule rule = GaussLegendre(n);
    for (int degree = 0; degree <= 2 * n - 1 && degree < 60; ++degree) {
      const double exact = degree % 2 == 0 ? 2.0 / (degree + 1) : 0.0;
      EXPECT_NEAR(Integrate(rule, -1, 1, [&](double x) { return std::pow(x, degree); }), exact, 2e-15)
          << n << " " << degree;
    }
    for (int i = 1; i < n; ++i) EXPECT_LT(rule.nodes[i - 1], rule.nodes[i]);
  }
  const double even = 2.0 / 9, missed = Integrate(GaussLegendre(4), -1, 1, [](double x) { return std::pow(x, 8); });
  EXPECT_GT(std::fabs(even - missed), 1e-3);
}

TEST(Adaptive, KronrodRuleIsExactToDegree22) {
  for (int degree = 0; degree <= 24; degree += 2) {
    const auto f = [&](double x) { return std::array<double, 1>{std::pow(x, degree)}; };
    const double error = internal::KronrodInterval<1>(f, -1, 1).value[0] - 2.0 / (degree + 1);
    if (degree <= 22) {
      EXPECT_NEAR(error, 0, 1e-15) << degree;
    } else {
      EXPECT_GT(std::fabs(error), 1e-12);
    }
  }
}

TEST(Adaptive, PeaksKinksAndEndpointSingularities) {
  EXPECT_NEAR(IntegrateAdaptive([](double x) { return 1 / (1e-10 + x * x); }, -1, 1), 2e5 * std::atan(1e5),
              1e-10 * kPi * 1e5);
  EXPECT_NEAR(IntegrateAdaptive([](double x) { return std::fabs(x - 0.3); }, 0, 1), 0.045 + 0.245, 1e-12);
  EXPECT_NEAR(IntegrateAdaptive([](double x) { return std::log(x); }, 0, 1), -1, 1e-11);
  EXPECT_NEAR(IntegrateAdaptive([](double x) { return std::sin(x); }, -2, 2), 0, 1e-14);
}

TEST(Adaptive, VectorsShareTheSubdivisionAndReportErrors) {
  const auto f = [](double x) { return std::array<double, 2>{std::sqrt(x), std::exp(-x)}; };
  const QuadratureResult<2> result = IntegrateAdaptive<2>(f, {0, 0.5, 3});
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.value[0], 2 * std::sqrt(3.0), 1e-11);
  EXPECT_NEAR(result.value[1], -std::expm1(-3), 1e-14);
  const auto jump = [](double x) { return std::array<double, 1>{x > 0.123 ? 1.0 : 0.0}; };
  const QuadratureResult<1> crude = IntegrateAdaptive<1>(jump, {0, 1}, {1e-12, 0, 5});
  EXPECT_FALSE(crude.converged);
  EXPECT_GE(crude.error[0], std::fabs(crude.value[0] - 0.877));
}

}  // namespace
}  // namespace lobefit
