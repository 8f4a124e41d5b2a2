// Every tabulated result of the five papers by name: its input columns with domains, its result columns, its source,
// and a pure function from the ones to the others. `lobefit eval`, its `--list` and the tests against the reference
// tables all read this table.
//
// Columns are those of the reference tables: directions are three columns (ox, oy, oz), d<f>_d<x> is the partial
// derivative of column f in column x. A direction is normalised here, in extended precision. Derivatives are NaN at
// kinks that have no side to prefer (SEL at alpha_x = alpha_y, ellipsoid_from_offcenter where two axes are equal) and 0
// on clamped branches.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

// A number, or one of a few words (then the value is the word's index).
struct InputColumn {
  std::string name;
  std::string unit;  // "1" for none, "text" for words
  std::string meaning;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;
  std::vector<std::string> words = {};
};

struct ResultColumn {
  std::string name;
  std::string unit;
  std::string meaning;   // empty for derivatives
  bool is_flag = false;  // 0 or 1
};

// What is wrong with the inputs, and the column that it is about.
struct DomainError {
  std::size_t column;
  std::string message;
};

struct Quantity {
  std::string name;
  std::string description;
  std::string source;  // paper and equation
  std::vector<InputColumn> inputs;
  std::vector<ResultColumn> results;
  std::vector<std::size_t> directions;  // first column of each direction
  // Domains that involve several columns; may be null. Called after every column has passed its own domain.
  std::optional<DomainError> (*check)(const double* inputs) = nullptr;
  // inputs.size() numbers to results.size() numbers. Pure; the inputs must have passed CheckDomain.
  void (*evaluate)(const double* inputs, double* results) = nullptr;
};

// All quantities, in alphabetical order.
const std::vector<Quantity>& Quantities();

// Null if there is none of that name.
const Quantity* FindQuantity(std::string_view name);

// The domain in words: "> 0", "in [-1, 1]", "any finite number", "one of beckmann, ggx".
std::string DomainText(const InputColumn& column);

// The first violation: a number that is not finite or outside its domain, a direction of length 0.
std::optional<DomainError> CheckDomain(const Quantity& quantity, const double* inputs);

}  // namespace lobefit
