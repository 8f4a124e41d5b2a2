// Comparison of a value with its whole gradient against a row of a reference table.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/reference_table.h"
#include <gtest/gtest.h>

namespace lobefit {

// |value - reference| <= 64 eps max(1, cond) |reference|.
inline void ExpectTableValue(const ReferenceTable& table, std::size_t row, const std::string& column, double value,
                             double cond) {
  const double reference = table(row, column);
  EXPECT_LE(std::fabs(value - reference), ValueTolerance(cond) * std::fabs(reference))
      << column << " in row " << row << ": " << value << " instead of " << reference << ", cond " << cond;
}

// Every derivative within `relative` of the largest finite one of the row; NaN exactly where the table has NaN.
inline void ExpectTableDerivatives(const ReferenceTable& table, std::size_t row,
                                   const std::vector<std::string>& columns, const std::vector<double>& values,
                                   double relative) {
  double largest = 0;
  for (const std::string& column : columns) {
    const double reference = table(row, column);
    if (std::isfinite(reference)) largest = std::fmax(largest, std::fabs(reference));
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double reference = table(row, columns[i]);
    EXPECT_EQ(std::isnan(values[i]), std::isnan(reference)) << columns[i] << " in row " << row;
    if (std::isnan(reference)) continue;
    EXPECT_LE(std::fabs(values[i] - reference), relative * largest)
        << columns[i] << " in row " << row << ": " << values[i] << " instead of " << reference;
  }
}

}  // namespace lobefit
