#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace lobefit {
namespace {

using SynthVerb = ProgramTest;

TEST_F(SynthVerb, NoiseFreeBrushedMetalIsRecoveredTo1e6) {
  ASSERT_EQ(Shell("lobefit synth $SOURCE/samples/brushed_metal.toml --phi-i 0,60,120 --detector-step 15 --out a.csv")
                .exit_code,
            0);
  const nlohmann::json p = nlohmann::json::parse(Shell("lobefit fit a.csv --json --no-report").out)["parameters"];
  EXPECT_NEAR(p["alpha_x"]["value"].get<double>(), 0.35, 1e-6 * 0.35);
  EXPECT_NEAR(p["alpha_y"]["value"].get<double>(), 0.11, 1e-6 * 0.11);
  EXPECT_NEAR(p["theta_x_deg"]["value"].get<double>(), 0, 1e-6);
  EXPECT_NEAR(p["theta_y_deg"]["value"].get<double>(), 3, 3e-6);
  EXPECT_NEAR(p["theta_z_deg"]["value"].get<double>(), 25, 25e-6);
  const double f0[] = {0.71, 0.66, 0.58}, diffuse[] = {0.02, 0.018, 0.015};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(p["f0"]["value"][c].get<double>(), f0[c], 1e-6 * f0[c]);
    EXPECT_NEAR(p["diffuse"]["value"][c].get<double>(), diffuse[c], 1e-6 * diffuse[c]);
  }
}

TEST_F(SynthVerb, TheSamplesAreMadeByTheCommandsOfTheirReadme) {
  // samples/README.md lists the command of each sample; made again, the bytes are the same but for the line with the
  // command.
  const std::string readme = ReadWholeFile(test::SourceDir() / "samples" / "README.md");
  const auto without_command = [](std::string text) { return text.substr(text.find('\n')); };
  std::stringstream lines(readme);
  int made = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("lobefit synth ", 0) != 0) continue;
    ASSERT_EQ(Shell("ln -sf $SOURCE/samples/*.toml . ; mkdir -p samples; cp $SOURCE/samples/*.toml samples/; " + line)
                  .exit_code,
              0)
        << line;
    const std::string out = line.substr(line.find("--out ") + 6);
    ++made;
    if (std::filesystem::is_directory(folder_ / out)) {  // an image stack
      for (const auto& entry : std::filesystem::directory_iterator(test::SourceDir() / out)) {
        const std::filesystem::path file = entry.path().filename();
        EXPECT_EQ(ReadWholeFile(folder_ / out / file), ReadWholeFile(entry.path())) << entry.path();
      }
      continue;
    }
    EXPECT_EQ(without_command(ReadWholeFile(folder_ / out)), without_command(ReadWholeFile(test::SourceDir() / out)))
        << out;
  }
  EXPECT_GE(made, 3);
}

TEST_F(SynthVerb, OneWavelengthStaysOne) {
  const ProgramResult result = Shell(
      "printf '[[lobe]]\\nndf = \"ggx\"\\n[parameters]\\nalpha_x = { start = 0.25 }\\nf0 = { start = 0.5 }\\n"
      "diffuse = { start = 0.1 }\\n' > laser.toml && lobefit synth laser.toml --channels 633nm --theta-i 30 "
      "--detector-step 30 --out laser.csv && lobefit info laser.csv");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("channels     633nm"), std::string::npos) << result.out;
}

TEST_F(SynthVerb, SynthesisesFromAMaterialToo) {
  ASSERT_EQ(Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --recipe ggx --no-report").exit_code, 0);
  const ProgramResult result = Shell(
      "lobefit synth satin_plastic.material.json --in-plane --theta-i 30,60 --out again.csv && lobefit info again.csv "
      "--json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("\"in_plane\": true"));
}

}  // namespace
}  // namespace lobefit
