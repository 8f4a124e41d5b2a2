#include "lobefit/base/text/text.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "lobefit/base/text/plain_decimal.h"

namespace lobefit {
namespace {

TEST(ParseDouble, TakesTheWholeFieldOrNothing) {
  EXPECT_EQ(ParseDouble("1.5"), 1.5);
  EXPECT_EQ(ParseDouble(" +2e-3\r"), 2e-3);
  EXPECT_EQ(ParseDouble("-.5"), -0.5);
  for (const char* bad : {"", " ", "1,5", "0.5abc", "1 2", "0x10", "--1", "+-1", "1e", "e5", "1.5f"}) {
    EXPECT_FALSE(ParseDouble(bad).has_value()) << bad;
  }
}

// The quick way for plain numbers gives the bits of the general one, or leaves the field to it.
TEST(ParseDouble, PlainDecimalsAreExact) {
  std::mt19937_64 random(5);
  std::size_t quick = 0;
  for (int i = 0; i < 100000; ++i) {
    std::string text = std::to_string(random() % 1000000000000000000ULL);
    text = text.substr(0, 1 + random() % text.size());
    if (random() % 4 != 0) text.insert(1 + random() % text.size(), ".");
    if (random() % 2 == 0) text.insert(0, "-");
    double expected = 0;
    std::from_chars(text.data(), text.data() + text.size(), expected);
    std::size_t length = 0;
    const std::optional<double> plain = ParsePlainDecimal(text, &length);
    if (plain && length == text.size()) {
      ++quick;
      EXPECT_EQ(std::bit_cast<std::uint64_t>(*plain), std::bit_cast<std::uint64_t>(expected)) << text;
    }
    EXPECT_EQ(ParseDouble(text), expected) << text;
    // Within a line: what follows is not part of it.
    std::size_t within = 0;
    const std::optional<double> first = ParsePlainDecimal(text + (i % 2 == 0 ? ",271828.18" : "/31415926"), &within);
    EXPECT_EQ(first, plain) << text;
    if (plain) {
      EXPECT_EQ(within, length) << text;
    }
  }
  EXPECT_GT(quick, 60000U);
  std::size_t length = 0;
  EXPECT_EQ(ParsePlainDecimal("12.5,3", &length), 12.5);
  EXPECT_EQ(length, 4U);
  EXPECT_TRUE(std::signbit(*ParsePlainDecimal("-0", &length)));
  for (const char* left : {"", "-", ".5", "5.", "+1", "nan", " 1", "1234567890123456", "0.1234567890123456"})
    EXPECT_FALSE(ParsePlainDecimal(left, &length)) << left;
}

TEST(ParseDouble, NonFiniteAndOutOfRange) {
  EXPECT_TRUE(std::isnan(*ParseDouble("nan")));
  EXPECT_TRUE(std::isnan(*ParseDouble("NaN")));
  EXPECT_EQ(*ParseDouble("-inf"), -HUGE_VAL);
  EXPECT_EQ(*ParseDouble("1e999"), HUGE_VAL);
  EXPECT_EQ(*ParseDouble("-1e999"), -HUGE_VAL);
  EXPECT_EQ(*ParseDouble("1e-999"), 0.0);
  // The exponent alone does not tell.
  const std::string zeros(400, '0');
  EXPECT_EQ(*ParseDouble("0." + zeros + "1"), 0.0);
  EXPECT_EQ(*ParseDouble("." + zeros + "1"), 0.0);
  EXPECT_EQ(*ParseDouble("1" + zeros + "e-5"), HUGE_VAL);
  EXPECT_EQ(*ParseDouble("-1" + zeros + ".5"), -HUGE_VAL);
  EXPECT_EQ(*ParseDouble("0." + zeros + "1e+5"), 0.0);
  EXPECT_EQ(*ParseDouble("1e99999999999999999999"), HUGE_VAL);
  EXPECT_NEAR(*ParseDouble("1" + zeros + "e-400"), 1.0, 1e-15);
}

TEST(ParseInteger, RefusesFractionsAndOverflow) {
  EXPECT_EQ(ParseInteger("42"), 42);
  EXPECT_EQ(ParseInteger("-7 "), -7);
  for (const char* bad : {"", "4.0", "9223372036854775808", "1e3"}) EXPECT_FALSE(ParseInteger(bad).has_value()) << bad;
}

TEST(FormatDouble, ReadsBackAsTheSameDouble) {
  for (const double value : {0.1, 1.0 / 3, 1e-300, -2.5e17, 0.0}) EXPECT_EQ(ParseDouble(FormatDouble(value)), value);
}

TEST(LineReader, TakesBothLineEndsAndALastLineWithout) {
  LineReader lines("a\r\nb\n\nc");
  std::string_view line;
  std::vector<std::string> found;
  while (lines.Next(&line)) found.emplace_back(line);
  EXPECT_EQ(found, (std::vector<std::string>{"a", "b", "", "c"}));
  EXPECT_EQ(lines.line_number(), 4U);
}

TEST(DidYouMean, SuggestsOnlyNearNames) {
  EXPECT_EQ(DidYouMean("alhpa", {"alpha", "beta"}), " (did you mean 'alpha'?)");
  EXPECT_EQ(DidYouMean("gamma", {"alpha", "beta"}), "");
}

}  // namespace
}  // namespace lobefit
