#include "lobefit/batch/run/flat_members.h"

#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

using testing::ElementsAre;
using testing::Pair;

std::vector<std::pair<std::string, std::string>> Members(std::string_view text) {
  std::vector<std::pair<std::string, std::string>> members;
  for (const FlatMember& member : FlatMembers(text)) members.emplace_back(member.name, member.value);
  return members;
}

TEST(FlatMembers, GivesMembersInOrder) {
  EXPECT_THAT(Members("{}"), testing::IsEmpty());
  EXPECT_THAT(Members(R"( { "a" : null, "b":true,"c":false,"d":-3,"e":1.5e-07,"f":"x" } )"),
              ElementsAre(Pair("a", "null"), Pair("b", "true"), Pair("c", "false"), Pair("d", "-3"),
                          Pair("e", "1.5e-07"), Pair("f", "x")));
}

TEST(FlatMembers, TakesEscapesBack) {
  EXPECT_THAT(Members(R"({"a\"b":"\\\/\b\f\n\r\t,\u0041\u00e4\u20AC\ud83d\ude00end","c":"{\"d\":1}"})"),
              ElementsAre(Pair("a\"b",
                               "\\/\b\f\n\r\t,A\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80"
                               "end"),
                          Pair("c", "{\"d\":1}")));
}

TEST(FlatMembers, RefusesWhatIsNoFlatObject) {
  for (const char* text : {"",
                           "3",
                           "[1]",
                           "{",
                           R"({"a":{}})",
                           R"({"a":[1]})",
                           R"({"a":1)",
                           R"({"a":1}})",
                           R"({"a":1,})",
                           R"({"a"})",
                           R"({"a":01})",
                           R"({"a":1.})",
                           R"({"a":1e})",
                           R"({"a":-})",
                           R"({"a":+1})",
                           R"({"a":nan})",
                           R"({"a":nul})",
                           R"({"a":"x)",
                           R"({"a":"\x"})",
                           R"({"a":"\u12"})",
                           R"({"a":"\ud83d"})",
                           R"({"a":"\ud83dx"})",
                           R"({"a":"\ude00"})",
                           R"({"\udfff":1})",
                           "{\"a\":\"\n\"}",
                           R"({"a":"\)",
                           R"({a:1})"}) {
    EXPECT_THROW(Members(text), InputError) << text;
  }
}

TEST(FlatMembers, AZeroDoesNotEndTheText) { EXPECT_THROW(Members(std::string_view("{}\0x", 4)), InputError); }

}  // namespace
}  // namespace lobefit
