// Comparison with rows of the reference tables, and random and hostile ellipsoids and directions for tests of laws.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/support/reference_table.h"
#include <gtest/gtest.h>

#include "lobefit/core/ellipsoid.h"

namespace lobefit {

inline const std::vector<std::string> kEllipsoidNames = {"alpha_x", "alpha_y", "theta_x", "theta_y", "theta_z"};

inline Ellipsoid EllipsoidOfRow(const ReferenceTable& table, std::size_t row) {
  return {table(row, "alpha_x"), table(row, "alpha_y"), table(row, "theta_x"), table(row, "theta_y"),
          table(row, "theta_z")};
}

inline Vec3 DirectionOfRow(const ReferenceTable& table, std::size_t row, const std::string& name) {
  return Normalized(Vec3{table(row, name + "x"), table(row, name + "y"), table(row, name + "z")});
}

// |value - expected| <= 64 eps max(1, cond) |expected|.
inline void ExpectValue(double value, double expected, double cond, std::size_t row) {
  EXPECT_NEAR(value, expected, ValueTolerance(cond) * std::abs(expected)) << "row " << row << ", cond " << cond;
}

// Each derivative within 1e-9 max(1, cond) of the row's largest.
inline void ExpectGradient(const double* gradient, const ReferenceTable& table, std::size_t row,
                           const std::string& prefix, const std::vector<std::string>& names, double cond) {
  double largest = 0;
  for (const std::string& name : names) largest = std::fmax(largest, std::abs(table(row, prefix + name)));
  for (std::size_t k = 0; k < names.size(); ++k) {
    EXPECT_NEAR(gradient[k], table(row, prefix + names[k]), 1e-9 * std::fmax(1, cond) * largest)
        << prefix << names[k] << ", row " << row;
  }
}

}  // namespace lobefit
