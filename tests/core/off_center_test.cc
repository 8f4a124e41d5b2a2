#include "lobefit/core/off_center.h"

#include "tests/support/reference_table.h"
#include "tests/support/shapes.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/core/slope_ndf.h"

namespace lobefit {
namespace {

const std::vector<std::string> kOffCenterNames = {"slope_x", "slope_y", "q11", "q12", "q22"};

// Tables without a cond column: 1e-12 relative to the value; to the row's largest for derivatives.
void ExpectJacobian(const double* jacobian, const ReferenceTable& table, std::size_t row,
                    const std::vector<std::string>& outputs, const std::vector<std::string>& inputs, double tolerance) {
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    double largest = 0;
    for (const std::string& input : inputs)
      largest = std::fmax(largest, std::abs(table(row, "d" + outputs[k] + "_d" + input)));
    for (std::size_t j = 0; j < inputs.size(); ++j) {
      const std::string name = "d" + outputs[k] + "_d" + inputs[j];
      EXPECT_NEAR(jacobian[5 * k + j], table(row, name), tolerance * largest) << name << ", row " << row;
    }
  }
}

TEST(OffCenterTables, FromEllipsoid) {
  const ReferenceTable table("offcenter_from_ellipsoid");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Ellipsoid e = EllipsoidOfRow(table, row);
    double jacobian[25];
    const OffCenter o = OffCenterFromEllipsoid(e, jacobian);
    const double values[5] = {o.slope_x, o.slope_y, o.q11, o.q12, o.q22};
    for (std::size_t k = 0; k < 5; ++k) {
      const double expected = table(row, kOffCenterNames[k]);
      EXPECT_NEAR(values[k], expected, 1e-12 * std::abs(expected)) << kOffCenterNames[k] << ", row " << row;
    }
    ExpectJacobian(jacobian, table, row, kOffCenterNames, kEllipsoidNames, 1e-9);
  }
}

TEST(OffCenterTables, EllipsoidFromOffCenter) {
  const ReferenceTable table("ellipsoid_from_offcenter");
  const std::vector<std::string> inputs = {"slope_x", "slope_y", "slope_alpha_x", "slope_alpha_y", "slope_r"};
  for (std::size_t row = 0; row < table.size(); ++row) {
    const double ax = table(row, "slope_alpha_x"), ay = table(row, "slope_alpha_y"), r = table(row, "slope_r");
    double jacobian[25], chained[25];
    const Ellipsoid e =
        EllipsoidFromOffCenter({table(row, "slope_x"), table(row, "slope_y"), ax * ax, ax * ay * r, ay * ay}, jacobian);
    const double values[5] = {e.alpha_x, e.alpha_y, e.theta_x, e.theta_y, e.theta_z};
    for (std::size_t k = 0; k < 5; ++k) {
      const double expected = table(row, kEllipsoidNames[k]);
      EXPECT_NEAR(values[k], expected, 1e-9 * std::abs(expected)) << kEllipsoidNames[k] << ", row " << row;
      // Chain from q11, q12, q22 to slope_alpha_x, slope_alpha_y, slope_r.
      const double* d = jacobian + 5 * k;
      chained[5 * k] = d[0];
      chained[5 * k + 1] = d[1];
      chained[5 * k + 2] = 2 * ax * d[2] + ay * r * d[3];
      chained[5 * k + 3] = ax * r * d[3] + 2 * ay * d[4];
      chained[5 * k + 4] = ax * ay * d[3];
    }
    ExpectJacobian(chained, table, row, kEllipsoidNames, inputs, 1e-9);
  }
}

}  // namespace
}  // namespace lobefit
