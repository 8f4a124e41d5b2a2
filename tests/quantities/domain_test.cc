// What a quantity says of its domain is what it checks, and what passes the check is evaluated.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/quantities/random_inputs.h"
#include <gtest/gtest.h>

#include "lobefit/base/text/text.h"
#include "lobefit/quantities/quantities.h"

namespace lobefit {
namespace {

class Domains : public testing::TestWithParam<std::string> {
 protected:
  const Quantity& quantity() const { return *FindQuantity(GetParam()); }

  // Whether the column's own domain takes the value; what is wrong with the row otherwise is another matter.
  bool Takes(std::size_t column, double value) const {
    std::vector<double> in = test::InputGenerator(3).Draw(quantity());
    in[column] = value;
    const std::optional<DomainError> error = CheckDomain(quantity(), in.data());
    return !error || error->column != column || error->message.find("out of domain") == std::string::npos;
  }
};

// The text is read as a person would: "> 0", ">= 1", "in (0, 1]", "any finite number".
TEST_P(Domains, AreCheckedAsTheTextSays) {
  constexpr double kHuge = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < quantity().inputs.size(); ++i) {
    const InputColumn& column = quantity().inputs[i];
    const std::string text = DomainText(column);
    SCOPED_TRACE(column.name + " " + text);
    if (!column.words.empty()) {
      for (const std::string& word : column.words) EXPECT_NE(text.find(word), std::string::npos);
      continue;
    }
    if (text == "any finite number") {
      EXPECT_TRUE(Takes(i, kHuge) && Takes(i, -kHuge) && Takes(i, 0));
      continue;
    }
    double low, high = HUGE_VAL;
    bool low_open, high_open = true;
    if (text[0] == '>') {
      low_open = text[1] != '=';
      low = ParseDouble(text.substr(text.find(' ') + 1)).value();
      EXPECT_TRUE(Takes(i, kHuge));
    } else {
      const std::size_t open = text.find_first_of("(["), comma = text.find(", ");
      low_open = text.at(open) == '(';
      high_open = text.back() == ')';
      low = ParseDouble(text.substr(open + 1, comma - open - 1)).value();
      high = ParseDouble(text.substr(comma + 2, text.size() - comma - 3)).value();
      EXPECT_EQ(Takes(i, high), !high_open);
      EXPECT_TRUE(Takes(i, std::nextafter(high, low)));
      EXPECT_FALSE(Takes(i, std::nextafter(high, HUGE_VAL)));
    }
    EXPECT_EQ(Takes(i, low), !low_open);
    EXPECT_TRUE(Takes(i, std::nextafter(low, HUGE_VAL)));
    EXPECT_FALSE(Takes(i, std::nextafter(low, -HUGE_VAL)));
  }
}

TEST_P(Domains, NumbersThatAreNotFiniteAreNamed) {
  for (std::size_t i = 0; i < quantity().inputs.size(); ++i) {
    if (!quantity().inputs[i].words.empty()) continue;
    for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
      std::vector<double> in = test::InputGenerator(3).Draw(quantity());
      in[i] = value;
      const std::optional<DomainError> error = CheckDomain(quantity(), in.data());
      ASSERT_TRUE(error.has_value()) << quantity().inputs[i].name;
      EXPECT_EQ(error->column, i);
      EXPECT_NE(error->message.find("allowed: " + DomainText(quantity().inputs[i])), std::string::npos);
    }
  }
}

// Directions are normalised in extended precision: powers of two do not change a bit, and no square overflows.
TEST_P(Domains, DirectionsHaveNoLength) {
  if (quantity().directions.empty() || test::IsQuadrature(quantity())) return;
  test::InputGenerator random(4);
  std::vector<double> once(quantity().results.size()), scaled(once.size());
  for (const int exponent : {1, -40, 600, -600}) {
    std::vector<double> in = random.Draw(quantity());
    quantity().evaluate(in.data(), once.data());
    for (const std::size_t first : quantity().directions) {
      for (std::size_t k = first; k < first + 3; ++k) in[k] = std::ldexp(in[k], exponent);
    }
    ASSERT_FALSE(CheckDomain(quantity(), in.data()).has_value());
    quantity().evaluate(in.data(), scaled.data());
    for (std::size_t k = 0; k < once.size(); ++k) {
      EXPECT_TRUE(once[k] == scaled[k] || (std::isnan(once[k]) && std::isnan(scaled[k])))
          << quantity().results[k].name << " " << once[k] << " becomes " << scaled[k] << " at 2^" << exponent;
    }
  }
}

// Rows that pass have a number in every column: nan only where the description says so.
TEST_P(Domains, AcceptedRowsHaveResults) {
  if (test::IsQuadrature(quantity())) return;
  test::InputGenerator random(5);
  const bool may_be_nan = quantity().description.find("nan") != std::string::npos;
  for (int row = 0; row < 50; ++row) {
    const std::vector<double> in = random.Draw(quantity());
    constexpr double kNotWritten = 12345.678;
    std::vector<double> out(quantity().results.size(), kNotWritten);
    quantity().evaluate(in.data(), out.data());
    for (std::size_t k = 0; k < out.size(); ++k) {
      const ResultColumn& column = quantity().results[k];
      EXPECT_NE(out[k], kNotWritten) << column.name;
      EXPECT_TRUE(std::isfinite(out[k]) || may_be_nan) << column.name << " " << test::Described(quantity(), in);
      EXPECT_TRUE(!column.is_flag || out[k] == 0 || out[k] == 1) << column.name;
    }
  }
}

std::vector<std::string> AllNames() {
  std::vector<std::string> names;
  for (const Quantity& quantity : Quantities()) names.push_back(quantity.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(All, Domains, testing::ValuesIn(AllNames()), [](const auto& test) { return test.param; });

// "all but t and ln_f are 0 at and below the horizon": there the slopes are infinitely far from the mean slope.
TEST(ProfileD, AtTheHorizon) {
  const Quantity& q = *FindQuantity("profile_D");
  std::vector<double> out(q.results.size());
  for (const double z : {0.0, -0.0, -0.5}) {
    const std::vector<double> in = {0.1, 0.2, 0.3, 0.1, -0.2, 0.1, 0.2, 0.1, 0, 0.1, 0.2, 0, 1, z};
    ASSERT_FALSE(CheckDomain(q, in.data()).has_value());
    q.evaluate(in.data(), out.data());
    if (z == 0) {
      EXPECT_EQ(out[0], HUGE_VAL);
      EXPECT_EQ(out[1], -HUGE_VAL);
    }
    for (std::size_t k = 2; k < out.size(); ++k) EXPECT_EQ(out[k], 0) << q.results[k].name;
  }
}

}  // namespace
}  // namespace lobefit
