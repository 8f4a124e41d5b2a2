// A table of reference values: CSV with a header, kept in tests/data/reference, or in the folder that the environment
// variable LOBEFIT_REFERENCE_TABLES names (tables of the same kind made with another seed). Numbers are parsed as
// doubles (inputs are exact doubles, shortest form), text columns (kind) are kept.
#pragma once

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/paths.h"
#include <gtest/gtest.h>

#include "lobefit/base/text/text.h"

namespace lobefit {

class ReferenceTable {
 public:
  explicit ReferenceTable(const std::string& name) {
    const char* other = std::getenv("LOBEFIT_REFERENCE_TABLES");
    const std::string folder = other != nullptr ? other : (test::SourceDir() / "tests/data/reference").string();
    std::ifstream in(folder + "/" + name + ".csv");
    EXPECT_TRUE(in.good()) << name;
    std::stringstream text;
    text << in.rdbuf();
    const std::string all = text.str();
    LineReader lines(all);
    std::string_view line;
    while (lines.Next(&line)) {
      std::vector<std::string> fields;
      for (const std::string_view field : Split(line, ',')) fields.emplace_back(field);
      if (columns_.empty()) {
        columns_ = fields;
      } else {
        rows_.push_back(fields);
      }
    }
    EXPECT_GT(rows_.size(), 10U) << name;
  }

  std::size_t size() const { return rows_.size(); }
  const std::vector<std::string>& columns() const { return columns_; }
  bool Has(const std::string& column) const { return Find(column) < columns_.size(); }
  const std::string& Text(std::size_t row, const std::string& column) const { return rows_[row].at(Find(column)); }
  double operator()(std::size_t row, const std::string& column) const {
    const std::optional<double> value = ParseDouble(Text(row, column));
    EXPECT_TRUE(value.has_value()) << column << " in row " << row;
    return value.value_or(std::numeric_limits<double>::quiet_NaN());
  }

 private:
  std::size_t Find(const std::string& column) const {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i] == column) return i;
    }
    return columns_.size();
  }

  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

// Accepted relative error of a value: 64 eps max(1, cond) (see MATH.md section 7 on test tolerances).
inline double ValueTolerance(double cond) { return 64 * std::numeric_limits<double>::epsilon() * std::fmax(1.0, cond); }

}  // namespace lobefit
