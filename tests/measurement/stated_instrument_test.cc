// What files and options state of an instrument, and the reasons for which samples are set aside.
#include "lobefit/measurement/stated_instrument.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "lobefit/measurement/set_aside.h"

namespace lobefit {
namespace {

TEST(ParseDrift, IsAutoOrAShare) {
  ASSERT_TRUE(ParseDrift("auto").has_value());
  EXPECT_FALSE(ParseDrift("auto")->sd.has_value());
  EXPECT_EQ(ParseDrift("0.03")->sd, 0.03);
  EXPECT_EQ(ParseDrift("1")->sd, 1);
  for (const char* bad : {"", "0", "-0.1", "1.01", "nan", "inf", "Auto", "3 %", "0.1x"})
    EXPECT_FALSE(ParseDrift(bad).has_value()) << bad;
}

TEST(ParseNoiseModel, TermsInAnyOrderOnce) {
  const StatedNoise all = {0.002, 0.03, 0.0001};
  EXPECT_EQ(ParseNoiseModel("floor=0.002, relative=0.03, poisson=0.0001"), all);
  EXPECT_EQ(ParseNoiseModel(" poisson = 1e-4,relative=.03 ,floor=2e-3"), all);
  EXPECT_EQ(ParseNoiseModel("relative=1,floor=0.5"), (StatedNoise{0.5, 1, 0}));
  EXPECT_EQ(ParseNoiseModel("relative=0.1,floor=0,poisson=2"), (StatedNoise{0, 0.1, 2}));
  for (const char* bad :
       {"", "floor=0.1", "relative=0.1", "floor=0,relative=0.1", "floor=0.1,relative=0", "floor=0.1,relative=1.5",
        "floor=-0.1,relative=0.1", "floor=nan,relative=0.1", "floor=inf,relative=0.1", "poisson=inf,relative=0.1",
        "floor=1,floor=2,relative=0.1", "floor=1,relative=0.1,relative=0.2", "floor,relative=0.1",
        "floor=,relative=0.1", "gain=1,floor=1,relative=0.1", "floor=1;relative=0.1", "Floor=1,relative=0.1"}) {
    EXPECT_FALSE(ParseNoiseModel(bad).has_value()) << bad;
  }
}

// Each reason has its own key for documents and its own words for people.
TEST(SetAside, ReasonsAreCountedApart) {
  SetAside aside;
  EXPECT_EQ(aside.total(), 0U);
  std::set<std::string> keys, words;
  std::size_t total = 0;
  for (int r = 0; r < kSetAsideReasons; ++r) {
    const auto reason = static_cast<SetAsideReason>(r);
    aside.Add(reason);
    aside.Add(reason, static_cast<std::size_t>(r));
    total += 1 + static_cast<std::size_t>(r);
    EXPECT_EQ(aside[reason], 1 + static_cast<std::size_t>(r));
    keys.insert(std::string(Key(reason)));
    words.insert(std::string(Words(reason)));
    EXPECT_EQ(std::string(Key(reason)).find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string::npos);
  }
  EXPECT_EQ(aside.total(), total);
  EXPECT_EQ(keys.size(), static_cast<std::size_t>(kSetAsideReasons));
  EXPECT_EQ(words.size(), static_cast<std::size_t>(kSetAsideReasons));
  EXPECT_EQ(keys.count(""), 0U);
  EXPECT_EQ(Key(SetAsideReason::kDiscAtHorizon), "disc_at_horizon") << "the last one";
}

}  // namespace
}  // namespace lobefit
