#include "tests/support/run_program.h"
#include "tests/support/schema.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace lobefit {
namespace {

using FitVerb = ProgramTest;

TEST_F(FitVerb, WritesADocumentAPictureAndAPage) {
  const ProgramResult result = Shell("lobefit fit $SOURCE/samples/brushed_metal.csv");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(Files(), testing::ElementsAre("brushed_metal.material.json", "brushed_metal.report.html",
                                            "brushed_metal.report.png"));
  // The plot in characters is for terminals.
  EXPECT_THAT(result.out, testing::Not(testing::HasSubstr("Worst slice")));
  EXPECT_THAT(result.out, testing::HasSubstr("theta_z_deg"));
  EXPECT_THAT(result.out, testing::HasSubstr("the simplest whose error on held-out incident directions"));
  EXPECT_TRUE(FollowsSchema(ReadWholeFile(folder_ / "brushed_metal.material.json")));
  EXPECT_EQ(ReadWholeFile(folder_ / "brushed_metal.report.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
}

TEST_F(FitVerb, PrintsTheSameDocumentAsJson) {
  const ProgramResult result =
      Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --json --no-report --name x --out sub/folder");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, ReadWholeFile(folder_ / "sub/folder/x.material.json"));
  EXPECT_TRUE(FollowsSchema(result.out));
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_THAT(json["command"].get<std::string>(), testing::HasSubstr("satin_plastic.csv --json"));
  EXPECT_EQ(json["source"]["sha256"].get<std::string>().size(), 64U);
  for (const char* timing : {"read", "fit", "report"}) EXPECT_TRUE(json["timings_s"].contains(timing));
}

// The automatic choice never picks what the fit then refuses.
TEST_F(FitVerb, FiveSamplesFitSomething) {
  WriteWholeFile(folder_ / "few.csv", "theta_i,theta_o,brdf\n0,0,0.3\n30,0,0.2\n30,30,0.9\n60,0,0.1\n60,60,2\n");
  const ProgramResult result = Shell("lobefit fit few.csv --no-report");
  EXPECT_THAT(result.exit_code, testing::AnyOf(0, 4)) << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("5 of 5 samples used"));
}

TEST_F(FitVerb, RecoversTheTruthOfItsSample) {
  // The truth of samples/brushed_metal.csv is in samples/brushed_metal.toml.
  const ProgramResult result = Shell("lobefit fit $SOURCE/samples/brushed_metal.csv --json --no-report");
  const nlohmann::json p = nlohmann::json::parse(result.out)["parameters"];
  const std::pair<const char*, double> truth[] = {
      {"alpha_x", 0.35}, {"alpha_y", 0.11}, {"theta_x_deg", 0}, {"theta_y_deg", 3}, {"theta_z_deg", 25}};
  for (const auto& [name, value] : truth) {
    EXPECT_LT(std::fabs(p[name]["value"].get<double>() - value), 3 * p[name]["stderr"].get<double>()) << name;
  }
}

TEST_F(FitVerb, SaysTheScatterOfAMirrorAsStrayLightProgramsTakeIt) {
  ASSERT_EQ(Shell("lobefit synth $SOURCE/samples/polished_mirror.toml --channels value --theta-i 5,30,60 --phi-i 0 "
                  "--in-plane --detector-step 0.5 --out mirror.csv")
                .exit_code,
            0);
  const ProgramResult result = Shell("lobefit fit mirror.csv --recipe abg --no-report");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("ABg: f_r = A / (B + |beta - beta0|^g)"));
  const std::string document = ReadWholeFile(folder_ / "mirror.material.json");
  EXPECT_TRUE(FollowsSchema(document));
  const nlohmann::json abg = nlohmann::json::parse(document)["abg"];
  EXPECT_NEAR(abg["lobes"][0]["A"].get<double>(), 1e-3, 2e-6);  // the sample's numbers have five digits
  EXPECT_NEAR(abg["lobes"][0]["B"].get<double>(), 1e-4, 2e-7);
  EXPECT_NEAR(abg["lobes"][0]["g"].get<double>(), 1.8, 1e-5);
  // Of the unit disc: 2 pi A int r / (B + r^g) dr at normal incidence, less to the side.
  ASSERT_EQ(abg["total_integrated_scatter"].size(), 3U);
  EXPECT_NEAR(abg["total_integrated_scatter"][0]["share"][0].get<double>(), 0.0198, 2e-4);
}

TEST_F(FitVerb, TakesTheNoiseOfTheReadingsAndRefusesWhatIsNone) {
  const std::string fit = "lobefit fit $SOURCE/samples/satin_plastic.csv --no-report --json ";
  const ProgramResult known = Shell(fit + "--recipe ggx --noise-model floor=0.001,relative=0.03");
  EXPECT_EQ(nlohmann::json::parse(known.out)["recipe"]["metric"], "asinh");
  for (const char* bad : {"--recipe ggx --noise-model floor=0.001", "--recipe ggx --noise-model 0.03",
                          "--recipe sel --noise-model floor=0.001,relative=0.03"}) {
    const ProgramResult refused = Shell(fit + bad);
    EXPECT_EQ(refused.exit_code, 2) << bad << refused.err;
  }
}

TEST_F(FitVerb, TakesARecipeByNameOrFileAndAPartOfTheFile) {
  WriteWholeFile(folder_ / "mine.toml", "metric = \"cube-root\"\n[[lobe]]\nndf = \"ggx\"\n");
  const ProgramResult by_file =
      Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --recipe mine.toml --theta-i 30:60 --json --no-report");
  ASSERT_EQ(by_file.exit_code, 0) << by_file.err;
  const nlohmann::json json = nlohmann::json::parse(by_file.out);
  EXPECT_EQ(json["recipe"]["metric"], "cube-root");
  EXPECT_GT(json["quality"]["set_aside"]["outside_selection"].get<int>(), 0);
  const ProgramResult by_name = Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --recipe ggx --json --no-report");
  EXPECT_NEAR(nlohmann::json::parse(by_name.out)["parameters"]["alpha_x"]["value"].get<double>(), 0.18, 0.005);
}

TEST_F(FitVerb, ExitsWith4WhereTheFitIsNotDetermined) {
  // A mirror pair of directions, measured again and again a little aside: f0, alpha and diffuse cannot be told apart.
  std::string csv = "theta_i,phi_i,theta_o,phi_o,value\n";
  for (int i = 0; i < 12; ++i) csv += "20,0," + std::to_string(20 + 1e-5 * i) + ",180,0.5\n";
  WriteWholeFile(folder_ / "one.csv", csv);
  const ProgramResult result = Shell("lobefit fit one.csv --recipe ggx --no-report");
  EXPECT_EQ(result.exit_code, 4) << result.out << result.err;
  EXPECT_THAT(result.err, testing::HasSubstr("does not determine every parameter"));
  const std::string document = ReadWholeFile(folder_ / "one.material.json");
  EXPECT_TRUE(FollowsSchema(document));
  EXPECT_FALSE(nlohmann::json::parse(document)["termination"]["determined"].get<bool>());
  EXPECT_FALSE(nlohmann::json::parse(document)["degenerate"].empty());
}

TEST_F(FitVerb, DrawsTheReportAgain) {
  ASSERT_EQ(Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --no-report").exit_code, 0);
  const ProgramResult result = Shell("lobefit report satin_plastic.material.json $SOURCE/samples/satin_plastic.csv");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(Files(), testing::Contains("satin_plastic.report.png"));
}

// Standard input, a pipe with a name that leads nowhere, and the file itself give the same document but for its name.
TEST_F(FitVerb, PipesAreReadLikeFiles) {
  const std::string options =
      " --recipe ggx --no-report --json | sed "
      "'/\"file\"\\|_s\"\\|\"command\"\\|\"fit\"\\|\"read\"\\|\"report\"\\|\"solve\"/d'";
  const std::string file = Shell("lobefit fit $SOURCE/samples/brushed_metal.csv" + options).out;
  EXPECT_EQ(Shell("cat $SOURCE/samples/brushed_metal.csv | lobefit fit -" + options).out, file);
  EXPECT_EQ(
      Shell("bash -c \"lobefit fit <(cat $SOURCE/samples/brushed_metal.csv) --recipe ggx --no-report --json\" | sed " +
            options.substr(options.find("sed ") + 4))
          .out,
      file);
  EXPECT_GT(file.size(), 1000U);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "stdin.material.json"));
  const ProgramResult twice = Shell("lobefit fit - - < $SOURCE/samples/brushed_metal.csv");
  EXPECT_EQ(twice.exit_code, 2);
}

}  // namespace
}  // namespace lobefit
