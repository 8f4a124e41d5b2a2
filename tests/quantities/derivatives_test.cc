// Every derivative column of every quantity against differences of the value column that it is of, at random inputs.
// The reference tables have their own derivatives; these are of the values that users get, wherever they ask.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tests/quantities/random_inputs.h"
#include <gtest/gtest.h>

#include "lobefit/quantities/quantities.h"

namespace lobefit {
namespace {

// Names of values and inputs are shortened in those of some derivatives, as in the reference tables.
const std::map<std::string, std::string> kShort = {
    {"Al", "A_l_uv"},      {"G1u", "G1_unclamped"}, {"Wsphere", "W_sphere"},
    {"Whemi", "W_hemi"},   {"G1o", "G1_o"},         {"s", "s_r"},
    {"rmin", "r_min"},     {"rmax", "r_max"},       {"thetao", "theta_o"},
    {"thetai", "theta_i"}, {"thetam", "theta_m"}};

std::string Full(const std::string& name) {
  const auto found = kShort.find(name);
  return found == kShort.end() ? name : found->second;
}

template <class Columns>
std::size_t PlaceOf(const Columns& columns, const std::string& name) {
  const auto at = std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == name; });
  return static_cast<std::size_t>(at - columns.begin());
}

// A derivative column: the places of the value and of the input; false for columns of values.
bool Splits(const Quantity& quantity, const std::string& column, std::size_t* value, std::size_t* input) {
  if (column[0] != 'd') return false;
  for (std::size_t cut = column.find("_d"); cut != std::string::npos; cut = column.find("_d", cut + 1)) {
    *value = PlaceOf(quantity.results, Full(column.substr(1, cut - 1)));
    *input = PlaceOf(quantity.inputs, Full(column.substr(cut + 2)));
    if (*value < quantity.results.size() && *input < quantity.inputs.size()) return true;
  }
  return false;
}

struct Estimate {
  double value, error;
};

// Central differences with shrinking steps, extrapolated to none [Ridders 1982]; the error is that of the best pair.
Estimate Differentiate(const Quantity& quantity, std::vector<double> in, std::size_t input, std::size_t value) {
  const double at = in[input];
  std::vector<double> out(quantity.results.size());
  bool inside = true;
  const auto f = [&](double x) {
    in[input] = x;
    inside = inside && !CheckDomain(quantity, in.data());
    if (inside) quantity.evaluate(in.data(), out.data());
    return inside ? out[value] : 0.0;
  };
  constexpr int kSteps = 8;
  constexpr double kShrink = 1.6;
  double table[kSteps][kSteps];
  double h = 0.02 * (at != 0 ? std::fmin(std::fabs(at), 0.5) : 0.1);
  Estimate best = {0, HUGE_VAL};
  for (int i = 0; i < kSteps && inside; ++i, h /= kShrink) {
    const volatile double high = at + h, low = at - h;
    table[0][i] = (f(high) - f(low)) / (high - low);
    double factor = kShrink * kShrink;
    for (int j = 1; j <= i; ++j, factor *= kShrink * kShrink) {
      table[j][i] = (table[j - 1][i] * factor - table[j - 1][i - 1]) / (factor - 1);
      const double error =
          std::fmax(std::fabs(table[j][i] - table[j - 1][i]), std::fabs(table[j][i] - table[j - 1][i - 1]));
      if (error < best.error) best = {table[j][i], error};
    }
  }
  return inside ? best : Estimate{0, HUGE_VAL};
}

bool SameFlags(const Quantity& quantity, const std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (quantity.results[k].is_flag && a[k] != b[k]) return false;
  }
  return true;
}

class Derivatives : public testing::TestWithParam<std::string> {};

TEST_P(Derivatives, AreThoseOfTheValues) {
  const Quantity& quantity = *FindQuantity(GetParam());
  test::InputGenerator random(11);
  std::vector<double> out(quantity.results.size()), beside(quantity.results.size());
  int sure = 0, all = 0;
  const int rows = quantity.results.size() < 16 ? 24 : 4;
  for (int row = 0; row < rows; ++row) {
    const std::vector<double> in = random.Draw(quantity);
    quantity.evaluate(in.data(), out.data());
    for (std::size_t k = 0; k < out.size(); ++k) {
      std::size_t value, input;
      if (!Splits(quantity, quantity.results[k].name, &value, &input)) {
        EXPECT_NE(quantity.results[k].meaning, "") << quantity.results[k].name << " is a derivative of nothing";
        continue;
      }
      ++all;
      const Estimate d = Differentiate(quantity, in, input, value);
      const double scale = std::fabs(d.value) + 1e-3 * std::fabs(out[value]);
      if (!(d.error <= 1e-5 * scale)) continue;
      // Not across the kink of a clamp.
      std::vector<double> moved = in;
      moved[input] *= 1.02;
      if (CheckDomain(quantity, moved.data())) continue;
      quantity.evaluate(moved.data(), beside.data());
      if (!SameFlags(quantity, out, beside)) continue;
      ++sure;
      EXPECT_NEAR(out[k], d.value, 1e-6 * scale + 10 * d.error)
          << quantity.results[k].name << " of " << test::Described(quantity, in);
    }
  }
  EXPECT_GE(sure, all / 2) << "of " << all << " differences that can be relied on";
}

std::vector<std::string> Names() {
  std::vector<std::string> names;
  for (const Quantity& quantity : Quantities()) {
    if (!test::IsQuadrature(quantity)) names.push_back(quantity.name);
  }
  return names;
}
INSTANTIATE_TEST_SUITE_P(All, Derivatives, testing::ValuesIn(Names()), [](const auto& test) { return test.param; });

}  // namespace
}  // namespace lobefit
