// The words for numbers of a material.
#include "lobefit/material/material.h"

#include <cmath>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/text/text.h"
#include "lobefit/material/badge.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

// Two digits below 100 %, whole percents above; never a power of ten, and the number that is meant.
TEST(PercentText, IsTheShare) {
  for (double share = 1e-3; share <= 10; share *= 1.003) {
    const std::string text = PercentText(share);
    ASSERT_TRUE(text.ends_with(" %")) << text;
    const std::optional<double> percent = ParseDouble(text.substr(0, text.size() - 2));
    ASSERT_TRUE(percent.has_value()) << text;
    EXPECT_NEAR(*percent, 100 * share, share < 1 ? 5.1 * share : 0.501) << text;
    EXPECT_EQ(text.find('e'), std::string::npos) << text;
  }
  EXPECT_EQ(PercentText(0), "0 %");
  EXPECT_EQ(PercentText(10.01), "over 1000 %");
  EXPECT_EQ(PercentText(HUGE_VAL), "over 1000 %");
  EXPECT_EQ(PercentText(std::nan("")), "unknown") << "null in a document is not a large error";
}

TEST(EnergyText, SpeaksOfWhatIsAboveOne) {
  EnergyBalance balance;
  balance.absolute = true;
  balance.channel = "R";
  balance.above_one = 3, balance.incidences = 12;
  balance.theta_i = kPi / 3;
  for (const double none : {0.0, 1.0, 1.005, std::nan("")}) {
    balance.albedo = none;
    EXPECT_EQ(EnergyText(balance), "") << none;
  }
  balance.albedo = 1.25;
  EXPECT_THAT(EnergyText(balance), testing::AllOf(testing::HasSubstr("1.25 at theta_i 60"), testing::HasSubstr("in R"),
                                                  testing::HasSubstr("3 of 12")));
  balance.absolute = false;
  EXPECT_EQ(EnergyText(balance), "") << "of an unknown scale nothing is above 1";
}

// Documents have the words of a verdict, and each verdict has its own.
TEST(Verdicts, AreToldApart) {
  std::set<std::string> words;
  for (const Choice<VerdictKind>& choice : VerdictChoices()) {
    words.insert(choice.name);
    EXPECT_EQ(Find(VerdictChoices(), choice.name)->value, choice.value);
    EXPECT_EQ(NameOf(VerdictChoices(), choice.value), choice.name);
  }
  EXPECT_EQ(words.size(), 4U);
  Material material;
  material.termination.converged = material.termination.determined = true;
  std::set<std::string> badges;
  for (const Choice<VerdictKind>& choice : VerdictChoices()) {
    material.verdict = Verdict{};
    material.verdict->kind = choice.value;
    material.verdict->typical_error = std::nan("");
    badges.insert(BadgeOf(material).words);
    EXPECT_THAT(BadgeOf(material).words, testing::EndsWith(", typical error unknown"));
  }
  EXPECT_EQ(badges.size(), 4U);
}

}  // namespace
}  // namespace lobefit
