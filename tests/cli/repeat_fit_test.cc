// A document holds all that its fit was made from: fitting the same file by it gives the same numbers to the last bit.
#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace lobefit {
namespace {

class RepeatedFit : public ProgramTest {
 protected:
  // Of a fit of the sample; what differs from run to run is left out.
  nlohmann::json Fit(const std::string& options, const std::string& name) {
    const ProgramResult result =
        Shell("lobefit fit $SOURCE/samples/" + sample_ + ".csv --no-report --json --name " + name + " " + options);
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 4) << options << "\n" << result.err;
    if (result.out.empty()) return {};
    nlohmann::json document = nlohmann::json::parse(result.out);
    for (const char* member : {"command", "timings_s"}) document.erase(member);
    // Models that were not tried again, and what to do after them.
    for (const char* member : {"tried", "advice"}) document["quality"].erase(member);
    return document;
  }

  // `base`: the same fit without the options, from which it must differ, or the test sees nothing.
  void ExpectRepeats(const std::string& options, const nlohmann::json& base) {
    const nlohmann::json once = Fit(options, "once"), again = Fit("--recipe once.material.json", "again");
    EXPECT_EQ(nlohmann::json::diff(once, again).dump(), "[]") << options;
    EXPECT_NE(once["cost"], base["quality"]["cost"]) << options;
    EXPECT_NE(once["parameters"], base["parameters"]) << options << " changes nothing";
  }

  std::string sample_ = "brushed_metal";
};

TEST_F(RepeatedFit, OfEveryOptionThatDecidesAFitHasTheSameBits) {
  const nlohmann::json base = Fit("--recipe ellipsoid", "base");
  for (const char* options :
       {"--metric log", "--metric asinh", "--weighting cells --metric relative", "--theta-max 61.7", "--scale free",
        "--source 1.1 --detector 2.3", "--detector 2.3 --mean plain", "--drift auto", "--drift 0.031",
        "--alignment 0.21", "--offset", "--theta-i 20:50", "--phi-i 0", "--channels luminance", "--noise-floor 0.013",
        "--exclude 'specular:7,value<0.02'"}) {
    ExpectRepeats(std::string("--recipe ellipsoid ") + options, base);
  }
}

TEST_F(RepeatedFit, OfARecipeWithEveryKeyHasTheSameBits) {
  const nlohmann::json base = Fit("--recipe ellipsoid", "base");
  WriteWholeFile(folder_ / "mine.toml", R"(name = "mine \"and\" yours\\"
metric = "log"
weighting = "cells"
theta_max_deg = 73.1
diffuse = "interfaced"
loss = { kind = "huber", scale = 0.017 }

[instrument]
detector = 1.7
drift = 0.013
alignment = { prior_deg = 0.17 }

[[lobe]]
ndf = "ellipsoid"
masking = "smith-height"
fresnel = "schlick"

[[lobe]]
ndf = "ggx"
fresnel = "none"

[parameters]
alpha_x = { start = 0.31, bounds = [0.013, 0.71] }
theta_x_deg = { bounds = [-7.3, 11.1] }
theta_y_deg = { fixed = 2.7 }
theta_z_deg = { start = 31.7, bounds = [-71.3, 81.9] }
f0 = { shared = true }
interface_ior = { fixed = 1.37 }
"lobe2.alpha_x" = { bounds = [0.1, 0.9] }
)");
  ExpectRepeats("--recipe mine.toml --starts 3 --seed 5", base);
}

TEST_F(RepeatedFit, OfAnAutomaticChoiceHasTheSameBits) {
  const nlohmann::json base = Fit("--recipe ggx", "base");
  ExpectRepeats("", base);
  sample_ = "satin_plastic";
  ExpectRepeats("--theta-i 10:60", Fit("--recipe ggx", "base"));
}

TEST_F(RepeatedFit, OfLobesHasTheSameBits) {
  sample_ = "satin_plastic";
  WriteWholeFile(folder_ / "lobes.toml", "metric = \"log\"\n[sel]\nlobes = 2\nquantity = \"f\"\ndrift = 2.3\n");
  const nlohmann::json once = Fit("--recipe lobes.toml --theta-i 30:60", "once"),
                       again = Fit("--recipe once.material.json", "again");
  EXPECT_FALSE(once["sel"]["slices"].empty());
  EXPECT_EQ(nlohmann::json::diff(once, again).dump(), "[]");
}

TEST_F(RepeatedFit, TakesWhatIsGivenOnTheCommandLineBeforeTheDocuments) {
  Fit("--recipe ellipsoid --metric log --theta-i 20:50 --seed 3 --starts 2", "once");
  const nlohmann::json other = Fit("--recipe once.material.json --metric cube-root --theta-i 10:60 --seed 4", "other");
  EXPECT_EQ(other["recipe"]["metric"], "cube-root");
  EXPECT_EQ(other["recipe"]["reading"]["theta-i"], "10:60");
  EXPECT_EQ(other["recipe"]["seed"], 4);
  EXPECT_EQ(other["recipe"]["starts"], 2);
}

TEST_F(RepeatedFit, SaysWhatADocumentLacks) {
  Fit("--recipe ggx", "once");
  const nlohmann::ordered_json document = nlohmann::ordered_json::parse(ReadWholeFile(folder_ / "once.material.json"));
  const auto fit = [&](const nlohmann::ordered_json& changed) {
    WriteWholeFile(folder_ / "changed.material.json", changed.dump());
    return Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --no-report --recipe changed.material.json");
  };
  EXPECT_EQ(fit(document).exit_code, 0) << fit(document).err;
  nlohmann::ordered_json changed = document;
  changed["recipe"].erase("text");
  EXPECT_EQ(fit(changed).exit_code, 3);
  EXPECT_THAT(fit(changed).err, testing::HasSubstr("changed.material.json: does not hold its recipe"));
  changed = document;
  changed["recipe"]["reading"]["angles"] = "3";
  EXPECT_EQ(fit(changed).exit_code, 3);
  EXPECT_THAT(fit(changed).err, testing::HasSubstr("read with --angles"));
  changed = document;
  changed["recipe"]["text"] = "name = 3\n[[lobe]]\n";
  EXPECT_EQ(fit(changed).exit_code, 3);
  EXPECT_THAT(fit(changed).err, testing::HasSubstr("changed.material.json, recipe:1: 'name' must be a string"));
  changed = document;
  changed["recipe"]["starts"] = 0;
  EXPECT_EQ(fit(changed).exit_code, 3);
  EXPECT_THAT(fit(changed).err, testing::HasSubstr("'starts' is 0"));
}

}  // namespace
}  // namespace lobefit
