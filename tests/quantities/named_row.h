// A row of a quantity by the names of its columns, as a user of `lobefit eval` gives it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "tests/quantities/random_inputs.h"
#include <gtest/gtest.h>

#include "lobefit/quantities/quantities.h"

namespace lobefit::test {

using Named = std::map<std::string, double>;

// Results by name. Inputs that are not given are 0; names that the quantity does not have are left aside.
inline Named Evaluated(const std::string& name, const Named& inputs) {
  const Quantity* quantity = FindQuantity(name);
  EXPECT_NE(quantity, nullptr) << name;
  std::vector<double> in, out(quantity->results.size());
  for (const InputColumn& column : quantity->inputs) {
    const auto found = inputs.find(column.name);
    in.push_back(found == inputs.end() ? 0 : found->second);
  }
  const std::optional<DomainError> error = CheckDomain(*quantity, in.data());
  EXPECT_FALSE(error.has_value()) << name << ": " << error->message;
  quantity->evaluate(in.data(), out.data());
  Named results;
  for (std::size_t k = 0; k < out.size(); ++k) results[quantity->results[k].name] = out[k];
  return results;
}

// Random rows of a quantity.
inline std::vector<Named> Rows(const std::string& name, unsigned seed, std::size_t count) {
  const Quantity& quantity = *FindQuantity(name);
  InputGenerator random(seed);
  std::vector<Named> rows(count);
  for (Named& row : rows) {
    const std::vector<double> in = random.Draw(quantity);
    for (std::size_t i = 0; i < in.size(); ++i) row[quantity.inputs[i].name] = in[i];
  }
  return rows;
}

inline Named With(Named row, const Named& more) {
  for (const auto& [name, value] : more) row[name] = value;
  return row;
}

// The three columns of a direction under another prefix.
inline Named Renamed(const Named& row, const std::string& from, const std::string& to) {
  Named result = row;
  for (const char* axis : {"x", "y", "z"}) result[to + axis] = row.at(from + axis);
  return result;
}
inline Named Swapped(const Named& row, const std::string& a, const std::string& b) {
  return With(Renamed(row, a, b), {{a + "x", row.at(b + "x")}, {a + "y", row.at(b + "y")}, {a + "z", row.at(b + "z")}});
}

inline void ExpectClose(double value, double expected, double relative, const std::string& what) {
  EXPECT_NEAR(value, expected, relative * std::max(std::abs(expected), 1e-300)) << what;
}

}  // namespace lobefit::test
