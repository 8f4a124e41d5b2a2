#include "lobefit/core/ellipsoid.h"

#include <random>

#include "tests/support/reference_table.h"
#include "tests/support/shapes.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

using Jet = ceres::Jet<double, 5>;

TEST(EllipsoidTables, D) {
  const ReferenceTable table("ellipsoid_D");
  for (std::size_t row = 0; row < table.size(); ++row) {
    double gradient[5];
    const double value = EllipsoidD(EllipsoidOfRow(table, row), DirectionOfRow(table, row, "m"), gradient);
    const double cond = table(row, "cond");
    ExpectValue(value, table(row, "D"), cond, row);
    ExpectGradient(gradient, table, row, "dD_d", kEllipsoidNames, cond);
  }
}

TEST(EllipsoidTables, SigmaAndG1) {
  const ReferenceTable table("ellipsoid_G1");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Ellipsoid e = EllipsoidOfRow(table, row);
    const Vec3 u = DirectionOfRow(table, row, "u");
    const double cond = table(row, "cond_sigma");
    double gradient[5];
    ExpectValue(EllipsoidSigma(e, u, gradient), table(row, "sigma"), cond, row);
    ExpectGradient(gradient, table, row, "dsigma_d", kEllipsoidNames, cond);
    ExpectValue(EllipsoidG1Unclamped(e, u, gradient), table(row, "G1_unclamped"), cond, row);
    ExpectGradient(gradient, table, row, "dG1u_d", kEllipsoidNames, cond);
    bool clamped;
    ExpectValue(EllipsoidG1(e, u, gradient, &clamped), table(row, "G1"), cond, row);
    EXPECT_EQ(clamped, table(row, "clamped") == 1) << row;
    if (clamped) {
      for (const double d : gradient) EXPECT_EQ(d, 0.0);
    }
  }
}

}  // namespace
}  // namespace lobefit
