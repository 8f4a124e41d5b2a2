#include "lobefit/math/student_t.h"

#include <cmath>

#include <gtest/gtest.h>

namespace lobefit {
namespace {

// Tables of the t distribution (two-sided 95 % and 99 %).
TEST(StudentT, QuantilesAgreeWithPublishedTables) {
  const struct {
    double freedom, at_975, at_995;
  } table[] = {{1, 12.7062, 63.6567},  {2, 4.30265, 9.92484},   {5, 2.57058, 4.03214},       {10, 2.22814, 3.16927},
               {35, 2.03011, 2.72381}, {120, 1.97993, 2.61742}, {INFINITY, 1.95996, 2.57583}};
  for (const auto& row : table) {
    EXPECT_NEAR(StudentTQuantile(0.975, row.freedom), row.at_975, 1e-5 * row.at_975) << row.freedom;
    EXPECT_NEAR(StudentTQuantile(0.995, row.freedom), row.at_995, 1e-5 * row.at_995) << row.freedom;
  }
}

TEST(StudentT, OneDegreeOfFreedomIsCauchyAndTwoHaveAClosedForm) {
  for (const double x : {-40.0, -3.0, -0.1, 0.0, 0.7, 5.0, 1e3}) {
    EXPECT_NEAR(StudentTCdf(x, 1), 0.5 + std::atan(x) / 3.141592653589793, 1e-13) << x;
    EXPECT_NEAR(StudentTCdf(x, 2), 0.5 + x / (2 * std::sqrt(2 + x * x)), 1e-13) << x;
  }
}

TEST(StudentT, FarTailsStayPositiveAndFall) {
  for (const double freedom : {3.0, 9.0, 40.0, 500.0}) {
    double before = 1;
    for (const double x : {-1.9, -2.1, -5.0, -9.0, -15.0, -30.0}) {
      const double tail = StudentTCdf(x, freedom);
      EXPECT_GT(tail, 0) << x << ' ' << freedom;
      EXPECT_LT(tail, before) << x << ' ' << freedom;
      before = tail;
    }
  }
}

TEST(StudentT, QuantileInvertsTheDistribution) {
  for (const double freedom : {1.0, 2.5, 7.0, 35.0, 1e4}) {
    for (const double p : {1e-6, 0.01, 0.16, 0.5, 0.84, 0.999}) {
      EXPECT_NEAR(StudentTCdf(StudentTQuantile(p, freedom), freedom), p, 1e-12) << freedom << ' ' << p;
    }
  }
}

}  // namespace
}  // namespace lobefit
