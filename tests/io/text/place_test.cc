// Places in files, words, and counts that files state.
#include "lobefit/io/text/place.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();

TEST(Place, MessagesNameFileAndPlace) {
  const InputFile file = {"dir/a.txt", "one\ntwo\n"};
  EXPECT_THAT([&] { FailAtLine(file, 7, "no light"); },
              ThrowsMessage<InputError>(HasSubstr("a.txt: line 7: no light")));
  EXPECT_THAT([&] { FailAtByte(file, 80, "cut"); }, ThrowsMessage<InputError>(HasSubstr("a.txt: byte 80: cut")));
  EXPECT_EQ(NumberAt(file, 2, "-1.5e2", "theta_i"), -150);
  EXPECT_EQ(NumberAt(file, 2, "inf", "theta_i"), HUGE_VAL);
  for (const char* bad : {"", "x", "1.5x", "1,5", "0x10", "--1", "1e"}) {
    EXPECT_THAT([&] { NumberAt(file, 3, bad, "theta_i"); },
                ThrowsMessage<InputError>(testing::AllOf(HasSubstr("line 3"), HasSubstr("theta_i"))))
        << bad;
  }
  for (const char* bad : {"nan", "inf", "-inf", "1e999"})
    EXPECT_THROW(FiniteNumberAt(file, 1, bad, "f"), InputError) << bad;
}

TEST(LineOfByte, CountsLineEnds) {
  const std::string text = "a\nbc\n\nd";
  const std::size_t expected[] = {1, 1, 2, 2, 2, 3, 4};
  for (std::size_t i = 0; i < text.size(); ++i) EXPECT_EQ(LineOfByte(text, i), expected[i]) << i;
  EXPECT_EQ(LineOfByte("", 0), 1U);
}

TEST(CheckedProduct, IsExactOrNothing) {
  EXPECT_EQ(CheckedProduct({}), 1U);
  EXPECT_EQ(CheckedProduct({6, 7, 8}), 336U);
  EXPECT_EQ(CheckedProduct({kMost, 1}), kMost);
  EXPECT_EQ(CheckedProduct({std::size_t{1} << 32U, (std::size_t{1} << 32U) - 1}),
            kMost - ((std::size_t{1} << 32U) - 1));
  EXPECT_EQ(CheckedProduct({std::size_t{1} << 32U, std::size_t{1} << 32U}), std::nullopt);
  EXPECT_EQ(CheckedProduct({kMost, 2}), std::nullopt);
  EXPECT_EQ(CheckedProduct({3, kMost / 2, 5}), std::nullopt);
  EXPECT_EQ(CheckedProduct({kMost, kMost, 0}).value_or(0), 0U) << "nothing, or none";
}

TEST(ScaleToMeanOne, KeepsRatios) {
  std::vector<double> factors = {1, 2, 5, 1e-3};
  const std::vector<double> before = factors;
  ScaleToMeanOne(&factors);
  EXPECT_NEAR(std::accumulate(factors.begin(), factors.end(), 0.0), 4, 1e-14);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(factors[i] / factors[0], before[i], 1e-15);
  std::vector<double> none;
  ScaleToMeanOne(&none);
  EXPECT_TRUE(none.empty());
}

TEST(HasLineWithFirstWord, LooksAtFirstWordsOnly) {
  EXPECT_TRUE(HasLineWithFirstWord("# a\n  Source  Measured\n", "Source"));
  EXPECT_TRUE(HasLineWithFirstWord("Source", "Source"));
  EXPECT_FALSE(HasLineWithFirstWord("the Source\nSources\nsource\n", "Source"));
  EXPECT_FALSE(HasLineWithFirstWord("", "Source"));
}

TEST(WordReader, WalksOverLinesAndComments) {
  const InputFile file = {"w.txt", "# head\none  two\n\n#no\n\tthree four \n5"};
  WordReader words(file);
  EXPECT_EQ(words.Peek(), "one");
  EXPECT_EQ(words.Next(), "one");
  EXPECT_EQ(words.line(), 2U);
  EXPECT_EQ(words.Peek(), "two");
  EXPECT_EQ(words.Next(), "two");
  EXPECT_EQ(words.line(), 2U);
  EXPECT_EQ(words.Word("a word"), "three");
  EXPECT_EQ(words.line(), 5U);
  EXPECT_THAT(std::string(words.RestOfLine()), HasSubstr("four"));
  EXPECT_EQ(words.Number("a number"), 5);
  EXPECT_EQ(words.line(), 6U);
  EXPECT_EQ(words.Next(), std::nullopt);
  EXPECT_EQ(words.Peek(), std::nullopt);
  EXPECT_THAT([&] { words.Word("the last angle"); },
              ThrowsMessage<InputError>(testing::AllOf(HasSubstr("w.txt"), HasSubstr("the last angle"))));
}

// A file of a few bytes does not make room for a billion numbers.
TEST(WordReader, CountsAreCheckedAgainstTheFile) {
  const auto refused = [](const std::string& text, const char* words) {
    const InputFile file = {"c.txt", text};
    EXPECT_THAT([&] { WordReader(file).List("angles", 0, 90); },
                ThrowsMessage<InputError>(testing::AllOf(HasSubstr("c.txt: line "), HasSubstr(words))))
        << text;
  };
  const InputFile good = {"c.txt", "3\n0 45\n90"};
  EXPECT_THAT(WordReader(good).List("angles", 0, 90), testing::ElementsAre(0, 45, 90));
  refused("4 0 45 90", "angles");
  refused("1000000000 0 45 90", "1000000000 values should follow, but the file has only");
  refused("18446744073709551616 0", "angles");
  refused("0", "angles");
  refused("-3 1 2 3", "angles");
  refused("2.5 1 2 3", "angles");
  refused("2 1 91", "angles");
  refused("2 1 nan", "angles");
  refused("", "angles");
  const InputFile file = {"r.txt", "1 2 3"};
  const WordReader words(file);
  words.ExpectRoomFor(3, "cells");
  EXPECT_THROW(words.ExpectRoomFor(4, "cells"), InputError);
  EXPECT_THROW(words.ExpectRoomFor(std::nullopt, "cells"), InputError);
}

TEST(Head, IsTheBeginning) {
  const std::string large(std::size_t{1} << 22U, 'x');
  EXPECT_EQ(Head("abc"), "abc");
  EXPECT_LT(Head(large).size(), large.size());
  EXPECT_EQ(Head(large), Head(large + "y")) << "the same for a file that is cut";
}

}  // namespace
}  // namespace lobefit
