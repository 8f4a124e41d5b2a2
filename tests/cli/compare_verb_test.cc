#include "tests/support/run_program.h"
#include "tests/support/schema.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace lobefit {
namespace {

using CompareVerb = ProgramTest;
constexpr const char* kComparisonSchema = "src/fit/comparison.schema.json";

TEST_F(CompareVerb, RecommendsTheTruthAndWritesItsDocument) {
  const ProgramResult result = Shell("lobefit compare $SOURCE/samples/brushed_metal.csv --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(FollowsSchema(result.out, kComparisonSchema));
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["recommended"]["name"], "ellipsoid");
  EXPECT_EQ(json["models"].size(), 4U);
  EXPECT_EQ(json["folds"], 5);
  const std::string document = ReadWholeFile(folder_ / "brushed_metal.material.json");
  EXPECT_TRUE(FollowsSchema(document));
  EXPECT_EQ(nlohmann::json::parse(document)["recipe"]["name"], "ellipsoid");
  EXPECT_EQ(nlohmann::json::parse(document)["recipe"]["reason"], json["recommended"]["reason"]);
}

TEST_F(CompareVerb, ShowsATableForPeople) {
  const ProgramResult result = Shell(
      "lobefit compare $SOURCE/samples/satin_plastic.csv --recipes ggx-anisotropic,ggx --folds 3 --metric cube-root");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("in 3 folds"));
  EXPECT_THAT(result.out, testing::HasSubstr("under metric cube-root"));
  EXPECT_THAT(result.out, testing::HasSubstr("\n> ggx "));
  EXPECT_THAT(result.out, testing::HasSubstr("Recommended: ggx "));
}

TEST_F(CompareVerb, ComparesWithAMaterialMadeByHand) {
  ASSERT_EQ(Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --no-report --name mine").exit_code, 0);
  const ProgramResult result = Shell(
      "lobefit compare $SOURCE/samples/satin_plastic.csv --recipes ggx --with mine.material.json --name out --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(FollowsSchema(result.out, kComparisonSchema));
  const nlohmann::json models = nlohmann::json::parse(result.out)["models"];
  ASSERT_EQ(models.size(), 2U);
  EXPECT_EQ(models[1]["name"], "mine.material.json");
  EXPECT_FALSE(models[1]["fitted"].get<bool>());
  EXPECT_THAT(models[1]["remarks"][0].get<std::string>(), testing::HasSubstr("was fitted to this measurement"));
}

TEST_F(CompareVerb, SaysWhyThereIsNoHeldOutErrorForOneIncidence) {
  const ProgramResult result =
      Shell("lobefit compare $SOURCE/samples/brushed_metal.csv --theta-i 30 --phi-i 0 --recipes ggx");
  EXPECT_THAT(result.out, testing::HasSubstr("one incident direction, so none can be held out"));
  EXPECT_THAT(result.out, testing::HasSubstr("least BIC"));
}

}  // namespace
}  // namespace lobefit
