#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace lobefit {
namespace {

using InfoVerb = ProgramTest;

TEST_F(InfoVerb, DescribesAFileInWordsAndAsJson) {
  const ProgramResult words = Shell("lobefit info $SOURCE/samples/brushed_metal.csv");
  EXPECT_EQ(words.exit_code, 0);
  EXPECT_THAT(words.out, testing::HasSubstr("36 directions"));
  const ProgramResult result = Shell("lobefit info $SOURCE/samples/brushed_metal.csv --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  for (const char* key : {"format", "samples", "set_aside", "channels", "incidences", "isotropic"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["format"], "csv");
  EXPECT_EQ(json["incidences"], 36);
  EXPECT_EQ(json["channels"], (nlohmann::json{"R", "G", "B"}));
  EXPECT_FALSE(json["isotropic"].get<bool>());
}

TEST_F(InfoVerb, ChoosesAPart) {
  const auto samples = [&](const std::string& options) {
    return nlohmann::json::parse(
               Shell("lobefit info $SOURCE/samples/brushed_metal.csv --json " + options).out)["samples"]
        .get<int>();
  };
  const int all = samples("");
  EXPECT_EQ(samples("--theta-i 0:40") + samples("--theta-i 42:90"), all);
  EXPECT_EQ(samples("--phi-i 0") + samples("--phi-i 60") + samples("--phi-i 100:140"), all);
  EXPECT_EQ(samples("--phi-i -300"), samples("--phi-i 60"));
}

TEST_F(InfoVerb, VersionAndHelp) {
  EXPECT_THAT(Shell("lobefit --version").out, testing::StartsWith("lobefit "));
  const ProgramResult help = Shell("lobefit --help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* verb : {"info", "fit", "synth", "report"}) EXPECT_THAT(help.out, testing::HasSubstr(verb));
}

}  // namespace
}  // namespace lobefit
