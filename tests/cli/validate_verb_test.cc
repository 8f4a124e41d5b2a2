#include <cmath>

#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace lobefit {
namespace {

using ValidateVerb = ProgramTest;

constexpr const char* kFew =
    "lobefit validate $SOURCE/samples/brushed_metal.toml --theta-i 10,30,50,65 --phi-i 0,60,120 --detector-step 20 ";

TEST_F(ValidateVerb, PrintsTheCalibrationOfEveryParameter) {
  const ProgramResult result = Shell(std::string(kFew) + "--noise 0.05 --trials 100");
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  for (const char* words : {"100 of 100 trials", "alpha_x", "theta_z_deg", "diffuse[B]", "95 % intervals", "PASSED"})
    EXPECT_THAT(result.out, testing::HasSubstr(words));
  EXPECT_EQ(result.err, "");
}

TEST_F(ValidateVerb, TheDocumentIsTheSameWithOneAndThreeThreads) {
  const auto document = [&](const char* threads) {
    const ProgramResult result =
        Shell(std::string(kFew) + "--noise multiplicative=0.05,drift=0.02 --trials 6 --json --threads " + threads);
    nlohmann::json json = nlohmann::json::parse(result.out);
    json.erase("command");
    json.erase("seconds_a_fit");
    return json;
  };
  const nlohmann::json one = document("1");
  EXPECT_EQ(one, document("3"));
  EXPECT_EQ(one["judged"], "clustered");
  EXPECT_EQ(one["trials"]["done"], 6);
}

TEST_F(ValidateVerb, AFileWithItsTruthIsFittedAndCompared) {
  ASSERT_EQ(
      Shell("lobefit synth $SOURCE/samples/brushed_metal.toml --phi-i 0,60,120 --detector-step 20 --noise "
            "multiplicative=0.03 --out a.csv && lobefit synth $SOURCE/samples/brushed_metal.toml --detector-step 20 "
            "--phi-i 0,90 --out b.alta")
          .exit_code,
      0);
  EXPECT_THAT(Files(), testing::Contains("b.alta.truth.json"));
  const ProgramResult csv = Shell("lobefit validate a.csv"), alta = Shell("lobefit validate b.alta");
  EXPECT_EQ(csv.exit_code, 0) << csv.out << csv.err;
  EXPECT_THAT(csv.out, testing::HasSubstr("alpha_x"));
  EXPECT_THAT(csv.out, testing::HasSubstr("noise multiplicative=0.03, seed 1"));
  EXPECT_EQ(alta.exit_code, 0) << alta.out << alta.err;
  const ProgramResult none = Shell("grep -v lobefit.truth a.csv > c.csv; lobefit validate c.csv");
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_THAT(none.err, testing::HasSubstr("carries no truth"));
}

TEST_F(ValidateVerb, WhatIsNotAllowedIsSaid) {
  const auto error = [&](const std::string& options) {
    const ProgramResult result = Shell("lobefit validate $SOURCE/samples/brushed_metal.toml " + options);
    EXPECT_EQ(result.exit_code, 2) << options;
    return result.err;
  };
  EXPECT_THAT(error("--trials 0"), testing::HasSubstr("--trials"));
  EXPECT_THAT(error("--layout goniometr"), testing::HasSubstr("did you mean 'goniometer'?"));
  EXPECT_THAT(error("--noise drif=1"), testing::HasSubstr("did you mean 'drift'?"));
  EXPECT_THAT(error("--noise aperture=6"), testing::HasSubstr("wider than the step of the grid, 5 degrees"));
  EXPECT_THAT(error("--noise holes=2"), testing::HasSubstr("[0, 0.99]"));
}

TEST_F(ValidateVerb, ASweepPrintsATableAParameterAndDrawsIt) {
  const ProgramResult result =
      Shell(std::string(kFew) + "--noise 0.05 --trials 6 --sweep alpha=0.2,0.4 --picture sweep.png");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  // A line each for the two values under the summary and under each of 11 entries.
  for (const char* value : {"0.2", "0.4"}) {
    std::size_t lines = 0;
    for (std::size_t at = result.out.find("\n" + std::string(value) + " "); at != std::string::npos;
         at = result.out.find("\n" + std::string(value) + " ", at + 1))
      ++lines;
    EXPECT_EQ(lines, 12U) << result.out;
  }
  EXPECT_THAT(Files(), testing::Contains("sweep.png"));
  EXPECT_EQ(Shell("head -c 4 sweep.png | tail -c 3").out, "PNG");

  const ProgramResult json = Shell(std::string(kFew) + "--noise 0.05 --trials 3 --sweep metric=log,relative --json");
  const std::size_t line = json.out.find('\n');
  EXPECT_EQ(nlohmann::json::parse(json.out.substr(0, line))["value"], "log");
  EXPECT_EQ(nlohmann::json::parse(json.out.substr(line))["value"], "relative");

  const ProgramResult unknown = Shell(std::string(kFew) + "--sweep alpa=1");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, testing::HasSubstr("did you mean 'alpha'?"));
}

TEST_F(ValidateVerb, ARunIsDrawn) {
  const ProgramResult result = Shell(std::string(kFew) + "--noise 0.05 --trials 20 --picture run.png");
  EXPECT_EQ(Shell("head -c 4 run.png | tail -c 3").out, "PNG") << result.err;
}

TEST_F(ValidateVerb, TheSelfCheckPassesLineByLine) {
  const ProgramResult result = Shell("lobefit validate --self-check");
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, testing::EndsWith("PASSED\n"));
  EXPECT_THAT(result.out, testing::Not(testing::HasSubstr("FAIL")));
}

TEST_F(ValidateVerb, AnInterruptedRunReportsTheTrialsThatItHas) {
  const ProgramResult result = Shell(
      "lobefit validate $SOURCE/samples/brushed_metal.toml --phi-i 0,60,120 --noise 0.05 --trials 100000 --json & "
      "sleep 2; kill -INT $!; wait $!");
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_LT(json["trials"]["done"], 100000);
  EXPECT_EQ(json["trials"]["planned"], 100000);
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_THAT(result.err, testing::HasSubstr("interrupted: "));
}

// Apart from the time that fits took, the same bytes.
TEST_F(ValidateVerb, PartsInAFolderAreTheWhole) {
  const std::string few = std::string(kFew) + "--noise multiplicative=0.05,drift=0.02 --trials 12 --json ";
  const auto document = [](const ProgramResult& result) {
    nlohmann::json json = nlohmann::json::parse(result.out);
    json.erase("command");
    json.erase("seconds_a_fit");
    return json;
  };
  const nlohmann::json whole = document(Shell(few));
  EXPECT_EQ(Shell(few + "--out parts --shard 2/3").exit_code, 0);
  const ProgramResult some = Shell(few + "--out parts --collect");
  EXPECT_EQ(some.exit_code, 5);
  EXPECT_EQ(document(some)["trials"]["done"], 4);
  EXPECT_THAT(some.err, testing::HasSubstr("4 of 12 trials are done"));
  // What a death cut short is done again.
  Shell("for f in parts/segments/*; do head -c -40 $f > cut; cat cut > $f; done");
  EXPECT_EQ(document(Shell(few + "--out parts --collect"))["trials"]["done"], 3);
  EXPECT_EQ(Shell(few + "--out parts --shard 1/2").exit_code, 0);
  EXPECT_EQ(document(Shell(few + "--out parts")), whole);
  EXPECT_EQ(document(Shell(few + "--out parts --collect")), whole);
  const ProgramResult other = Shell(few + "--out parts --seed 2");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, testing::HasSubstr("holds trials of another validation"));
  for (const char* bad : {"--collect", "--shard 1/2", "--shard 3/2 --out parts", "--submit --out parts",
                          "--sweep alpha=0.2 --out parts", "--engine slurm --shards 13 --out parts"})
    EXPECT_EQ(Shell(few + bad).exit_code, 2) << bad;
}

TEST_F(ValidateVerb, ShowsWhatTheInstrumentGains) {
  const std::string through =
      std::string(kFew) + "--recipe ellipsoid --noise multiplicative=0.02,aperture=5 --trials 12 --json ";
  const ProgramResult result = Shell(through + "--detector 5 --without-instrument");
  const nlohmann::json json = nlohmann::json::parse(result.out);
  const auto bias_of = [](const nlohmann::json& parameters) {
    const nlohmann::json& alpha = parameters["alpha_y"];
    return std::fabs(alpha["bias"].get<double>()) / alpha["mean_stderr"].get<double>();
  };
  EXPECT_LT(bias_of(json["parameters"]), 1.2);
  EXPECT_GT(bias_of(json["without_instrument"]["parameters"]), 5);
  const ProgramResult nothing = Shell(through + "--without-instrument");
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_THAT(nothing.err, testing::HasSubstr("give --source, --detector"));
}

}  // namespace
}  // namespace lobefit
