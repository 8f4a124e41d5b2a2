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

TEST(StudentT, NotANumberIsNoException) {
  EXPECT_TRUE(std::isnan(StudentTQuantile(0.975, std::nan(""))));
  EXPECT_TRUE(std::isnan(StudentTCdf(1, std::nan(""))));
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

// Incomplete beta functions of mpmath at 40 digits. A difference of log-gamma functions loses a digit for each factor
// of ten in the degrees of freedom.
TEST(StudentT, AgreesToTwelveDigitsFromAFractionToABillionDegreesOfFreedom) {
  const struct {
    double x, freedom, below;
  } table[] = {
      {-8.5, 0.7, 0.06934334715196752},     {-2.5, 0.7, 0.15985218134063689},    {-0.4, 0.7, 0.3889381333892061},
      {-8.5, 3.5, 0.00092885026502422929},  {-2.5, 3.5, 0.03784732190474504},    {-0.4, 3.5, 0.35617244676722193},
      {-8.5, 1000, 3.4095574473320805e-17}, {-2.5, 1000, 0.0062892839005453984}, {-0.4, 1000, 0.3446209716330291},
      {-8.5, 1e6, 9.49225399550358e-18},    {-2.5, 1e6, 0.0062097447510816231},  {-0.4, 1e6, 0.34457830110900602},
      {-8.5, 1e8, 9.4796619355562378e-18},  {-2.5, 1e8, 0.0062096661200272707},  {-0.4, 1e8, 0.3445782588168692},
      {-8.5, 1e9, 9.4795475334673829e-18},  {-2.5, 1e9, 0.006209665405201247},   {-0.4, 1e9, 0.34457825843239517},
  };
  for (const auto& row : table) {
    EXPECT_NEAR(StudentTCdf(row.x, row.freedom), row.below, 1e-12 * row.below) << row.x << ' ' << row.freedom;
    EXPECT_NEAR(StudentTCdf(-row.x, row.freedom), 1 - row.below, 1e-15) << row.x << ' ' << row.freedom;
    EXPECT_NEAR(StudentTQuantile(row.below, row.freedom), row.x, 1e-12 * -row.x) << row.x << ' ' << row.freedom;
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
