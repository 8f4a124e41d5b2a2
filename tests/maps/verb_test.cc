#include <csignal>
#include <thread>

#include "tests/maps/texels.h"
#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace lobefit {
namespace {

using MapsVerb = ProgramTest;
using testing::HasSubstr;

TEST_F(MapsVerb, ANoiseFreeStackGivesItsTruthBack) {
  ASSERT_EQ(Shell("lobefit synth hills --stack --size 24 --lights 64 --bits 32 --out s").exit_code, 0);
  const ProgramResult result = Shell("lobefit maps s --out o --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json document = nlohmann::json::parse(result.out)["document"];
  EXPECT_EQ(document["texels"]["fitted"], 576);
  EXPECT_EQ(document["texels"]["normal_determined"], 576);
  EXPECT_EQ(document["texels"]["no_lobe"], 48);  // the two columns at the left
  const Maps truth = ReadMapsExr(folder_ / "s/truth.maps.exr"), found = ReadMapsExr(folder_ / "o/s.maps.exr");
  for (std::size_t t = 0; t < 576; ++t) {
    EXPECT_LT(test::AngleBetween(test::NormalAt(found, t), test::NormalAt(truth, t)), 3e-7);
    for (const char* name : {"diffuse.R", "f0.G", "alpha"}) {
      const double expected = test::At(truth, MapPart::kParameters, name, t);
      const double value = test::At(found, MapPart::kParameters, name, t);
      EXPECT_EQ(std::isnan(value), std::isnan(expected)) << name << t;
      if (!std::isnan(expected)) {
        EXPECT_NEAR(value, expected, 2e-6) << name;
      }
    }
  }
}

TEST_F(MapsVerb, AStackMadeFromMapsIsFittedToTheSameMaps) {
  // maps -> synth -> maps: what is written is read back as it was meant.
  ASSERT_EQ(Shell("lobefit synth hills --stack --size 16 --lights 48 --bits 32 --out s && lobefit maps s --out o && "
                  "lobefit synth o/s.maps.exr --stack --lights s/lights.lp --bits 32 --out again && lobefit maps again "
                  "--out o")
                .exit_code,
            0);
  const Maps first = ReadMapsExr(folder_ / "o/s.maps.exr"), second = ReadMapsExr(folder_ / "o/again.maps.exr");
  for (std::size_t t = 0; t < 256; ++t) {
    EXPECT_LT(test::AngleBetween(test::NormalAt(first, t), test::NormalAt(second, t)), 3e-7);
  }
}

TEST_F(MapsVerb, ThreadsShardsAndMergeGiveTheSameBytes) {
  ASSERT_EQ(
      Shell("lobefit synth hills --stack --size 40 --lights 24 --noise multiplicative=0.02,additive=0.001 --out s")
          .exit_code,
      0);
  ASSERT_EQ(Shell("lobefit maps s --out one --threads 1; lobefit maps s --out four --threads 4").exit_code, 0);
  EXPECT_EQ(Files(), (std::vector<std::string>{"four", "one", "s"}));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "one/s.maps.part"));
  const std::string bytes = Read("one/s.maps.exr");
  EXPECT_EQ(Read("four/s.maps.exr"), bytes);
  ASSERT_EQ(Shell("lobefit maps s --out parts --rows 13:40").exit_code, 0);
  const ProgramResult gap = Shell("lobefit maps s --out parts --merge");
  EXPECT_EQ(gap.exit_code, 5);
  EXPECT_THAT(gap.err, HasSubstr("rows 0:13 are missing"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "parts/s.maps.exr"));
  ASSERT_EQ(Shell("lobefit maps s --out parts --rows 0:15 && lobefit maps s --out parts --merge").exit_code, 0);
  EXPECT_EQ(Read("parts/s.maps.exr"), bytes);
  for (const char* file : {"s.normal.png", "s.diffuse.png", "s.f0.png", "s.alpha.png", "s.normal_error.png"}) {
    EXPECT_EQ(Read(std::string("parts/") + file), Read(std::string("one/") + file)) << file;
  }
  // Bands of other settings are not taken for these.
  ASSERT_EQ(Shell("lobefit maps s --out parts --rows 0:15 --recipe lambert-maps").exit_code, 0);
  EXPECT_EQ(Shell("lobefit maps s --out parts --merge").exit_code, 5);
}

TEST_F(MapsVerb, ASharedWidthIsTheSameInEveryShard) {
  ASSERT_EQ(Shell("lobefit synth hills --stack --size 24 --lights 24 --noise 0.02 --out s").exit_code, 0);
  ASSERT_EQ(Shell("lobefit maps s --out one --recipe ggx-shared-maps && lobefit maps s --out two --rows 10:24 --recipe "
                  "ggx-shared-maps && lobefit maps s --out two --recipe ggx-shared-maps --threads 3")
                .exit_code,
            0);
  EXPECT_EQ(Read("one/s.maps.exr"), Read("two/s.maps.exr"));
  const nlohmann::json document = nlohmann::json::parse(Read("two/s.maps.json"));
  EXPECT_GT(document["shared"][0]["alpha"].get<double>(), 0.1);
  EXPECT_LT(document["shared"][0]["alpha"].get<double>(), 0.4);
}

TEST_F(MapsVerb, KilledAndRunAgainGivesTheSameBytes) {
  ASSERT_EQ(Shell("lobefit synth hills --stack --size 128 --lights 32 --noise 0.02 --out s").exit_code, 0);
  ASSERT_EQ(Shell("lobefit maps s --out whole").exit_code, 0);
  // Killed as soon as the first bands are written; `wait` has the shell's message swallowed.
  const ProgramResult killed = Shell(
      "lobefit maps s --out cut & pid=$!; while [ -z \"$(ls cut/s.maps.part 2>/dev/null)\" ]; do sleep 0.002; done; "
      "kill -9 $pid; wait $pid; ls cut/s.maps.part | wc -l; ls cut | wc -l");
  const std::string left = killed.out;
  EXPECT_THAT(left, testing::Not(HasSubstr("Wrote")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cut/s.maps.exr"));
  const ProgramResult again = Shell("lobefit maps s --out cut --json");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_LT(nlohmann::json::parse(again.out)["texels_fitted"].get<int>(), 128 * 128);
  EXPECT_EQ(Read("cut/s.maps.exr"), Read("whole/s.maps.exr"));
  // A band that a broken disk cut short is fitted again.
  ASSERT_EQ(Shell("lobefit maps s --out third --rows 0:64").exit_code, 0);
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "third/s.maps.part")) {
    std::filesystem::resize_file(entry.path(), 1000);
  }
  ASSERT_EQ(Shell("lobefit maps s --out third").exit_code, 0);
  EXPECT_EQ(Read("third/s.maps.exr"), Read("whole/s.maps.exr"));
}

TEST_F(MapsVerb, MapsAreExportedAndReported) {
  ASSERT_EQ(
      Shell("lobefit synth hills --stack --size 16 --lights 24 --light-distance 3 --out s && lobefit maps s --out o "
            "--leave-out 4")
          .exit_code,
      0);
  EXPECT_THAT(Shell("lobefit info s").out, HasSubstr("near: 300 mm from the middle of a picture of 100 mm"));
  const ProgramResult done =
      Shell("lobefit export o/s.maps.exr --to merl,gltf,mitsuba --out e --map-path e --normal-y down");
  EXPECT_EQ(done.exit_code, 3);
  EXPECT_THAT(done.err, HasSubstr("merl cannot hold this material: it takes one material"));
  EXPECT_THAT(done.out, HasSubstr("\ngltf           copied"));
  EXPECT_THAT(Read("e/s.mitsuba.xml"), HasSubstr("value=\"e/s_normal.png\""));
  EXPECT_FALSE(Read("e/s_normal_down.png").empty());
  const nlohmann::json record = nlohmann::json::parse(Read("e/s.export.json"));
  EXPECT_EQ(record["targets"].size(), 2U);
  EXPECT_TRUE(record["targets"][0]["relative_error"]["albedo"].is_null());
  const ProgramResult report = Shell("lobefit report o/s.maps.exr s --format png,html --out r");
  EXPECT_EQ(report.exit_code, 2);  // neither a folder nor a picture
  ASSERT_EQ(Shell("mkdir r && lobefit report o/s.maps.exr s --format png,html --out r").exit_code, 0);
  EXPECT_THAT(Read("r/s.maps.report.html"), HasSubstr("How lights are met"));
  EXPECT_EQ(Shell("lobefit report o/s.maps.exr s --format exr").exit_code, 2);
}

TEST_F(MapsVerb, BadInputEndsWithItsCodeAndCure) {
  ASSERT_EQ(Shell("lobefit synth hills --stack --size 8 --lights 12 --out s").exit_code, 0);
  const auto refused = [&](const std::string& command, int code, const std::string& words) {
    const ProgramResult result = Shell(command);
    EXPECT_EQ(result.exit_code, code) << command << result.err;
    EXPECT_THAT(result.err, HasSubstr(words)) << command;
  };
  refused("lobefit maps nowhere", 3, "nowhere: is not there");
  refused("mkdir empty && lobefit maps empty", 3, "a stack.toml, DiLiGenT's filenames.txt, a light file (.lp, .dome, MaterialGAN's");
  refused("lobefit maps s --recipe ggx-map", 3, "did you mean 'ggx-maps'?");
  refused("lobefit maps s --rows 5:3", 2, "A:B with 0 <= A < B <= 8 is expected");
  refused("lobefit maps s --leave-out 13", 2, "numbers of lights from 1 to 12");
  refused("echo 'model = \"ellipsoid\"' > e.toml; lobefit maps s --recipe e.toml", 2,
          "the tilt of an ellipsoid and a free normal say the same");
  refused("printf 'loss = 0.05\\nmodle = 1\\n' > e.toml; lobefit maps s --recipe e.toml", 3,
          "e.toml:2: unknown key 'modle' (did you mean 'model'?)");
  refused("lobefit maps s --out s --name 001 && lobefit maps s/lights.lp --out /proc/nothing", 3, "cannot be made");
  refused("lobefit export s.maps.exr --to gltf", 3, "s.maps.json: cannot be opened");
  refused("lobefit export s.maps.exr --to gltf --copy", 2, "--refit and --copy are for one material");
  refused("lobefit export a.material.json --to gltf --normal-y down", 2, "--white and --normal-y are for maps");
  refused("rm s/003.png; lobefit maps s", 3, "003.png: cannot be opened");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.maps.exr"));
}

}  // namespace
}  // namespace lobefit
