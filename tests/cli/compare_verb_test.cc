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
  ASSERT_EQ(json["models"].size(), 5U);
  EXPECT_EQ(json["models"][4]["name"], "sel") << "its incident directions can feed lobes";
  EXPECT_EQ(json["folds"], 5);
  EXPECT_THAT(Files(), testing::ElementsAre("brushed_metal.compare.png", "brushed_metal.material.json"));
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
  ASSERT_EQ(Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --recipe ellipsoid --no-report --name mine").exit_code,
            0);
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

TEST_F(CompareVerb, ShowsATableOfLobesBesideModels) {
  const ProgramResult fit = Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --recipe sel --json --no-report");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_TRUE(FollowsSchema(fit.out));
  EXPECT_EQ(nlohmann::json::parse(fit.out)["sel"]["slices"].size(), 5U);
  const ProgramResult report = Shell("lobefit report satin_plastic.material.json $SOURCE/samples/satin_plastic.csv");
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(Files(), testing::Contains("satin_plastic.report.png"));
  const ProgramResult result =
      Shell("lobefit compare $SOURCE/samples/satin_plastic.csv --recipes sel,ggx --json --no-report");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(FollowsSchema(result.out, kComparisonSchema));
  EXPECT_EQ(nlohmann::json::parse(result.out)["recommended"]["name"], "ggx");
}

TEST_F(CompareVerb, LobesCanBeFittedToAMaterial) {
  ASSERT_EQ(Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --recipe ellipsoid --no-report --name mine").exit_code,
            0);
  const ProgramResult result = Shell("lobefit fit mine.material.json --recipe sel --theta-i 20:40");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("24 incident directions, 2 squared ellipsoidal lobes"));
  EXPECT_THAT(Files(), testing::Contains("mine.sel.material.json"));
  const ProgramResult without = Shell("lobefit fit mine.material.json");
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_THAT(without.err, testing::HasSubstr("add --recipe sel"));
}

TEST_F(CompareVerb, SaysWhyThereIsNoHeldOutErrorForOneIncidence) {
  const ProgramResult result =
      Shell("lobefit compare $SOURCE/samples/brushed_metal.csv --theta-i 30 --phi-i 0 --recipes ggx");
  EXPECT_THAT(result.out, testing::HasSubstr("one incident direction, so none can be held out"));
  EXPECT_THAT(result.out, testing::HasSubstr("least BIC"));
}

}  // namespace
}  // namespace lobefit
