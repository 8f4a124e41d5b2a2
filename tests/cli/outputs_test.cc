// What a verb writes never takes the place of what it reads, by whatever name.
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/text/printable.h"

namespace lobefit {
namespace {

using Outputs = ProgramTest;

TEST_F(Outputs, AnInputIsNeverOverwritten) {
  const std::string sample = ReadWholeFile(test::SourceDir() / "samples/satin_plastic.csv");
  WriteWholeFile(folder_ / "over.csv", sample);
  ASSERT_EQ(Shell("ln -s over.csv link.csv && mkdir part && cp over.csv part/one.csv").exit_code, 0);
  ASSERT_EQ(Shell("lobefit fit over.csv --recipe ggx --no-report --name m").exit_code, 0);
  const std::string material = ReadWholeFile(folder_ / "m.material.json");
  for (const char* command :
       {"lobefit convert over.csv over.csv", "lobefit convert over.csv ./link.csv", "lobefit convert part part/one.csv",
        "lobefit compare over.csv --recipes ggx --with m.material.json --name m --no-report"}) {
    const ProgramResult result = Shell(command);
    EXPECT_EQ(result.exit_code, 2) << command << result.err;
    EXPECT_THAT(result.err, testing::HasSubstr("which would be overwritten; choose another name")) << command;
  }
  EXPECT_EQ(ReadWholeFile(folder_ / "over.csv"), sample);
  EXPECT_EQ(ReadWholeFile(folder_ / "part/one.csv"), sample);
  EXPECT_EQ(ReadWholeFile(folder_ / "m.material.json"), material);
}

TEST_F(Outputs, AFormatIsCheckedBeforeAFolderIsMade) {
  const ProgramResult result =
      Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --recipe ggx --format pdf --out new");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, testing::HasSubstr("--format 'pdf' is unknown"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new"));
}

// Nothing is read back from them: that would wait for ever, or take standard input for the result.
TEST_F(Outputs, ConversionsGoThroughPipesAndDevices) {
  const ProgramResult file = Shell("cp $SOURCE/samples/satin_plastic.csv a.csv && lobefit convert a.csv b.csv");
  ASSERT_EQ(file.exit_code, 0) << file.err;
  const std::string csv = ReadWholeFile(folder_ / "b.csv");
  const ProgramResult standard = Shell("timeout 60 lobefit convert a.csv - --to csv");
  EXPECT_EQ(standard.exit_code, 0) << standard.err;
  EXPECT_EQ(standard.out, csv);
  EXPECT_THAT(standard.err, testing::HasSubstr("Not compared: what went into a pipe or device is not read back"));
  const ProgramResult pipe = Shell(
      "mkfifo p && { cat p > got & } && timeout 60 lobefit convert - p --to csv < a.csv && wait && cmp got b.csv");
  EXPECT_EQ(pipe.exit_code, 0) << pipe.err;
  EXPECT_EQ(Shell("timeout 60 lobefit convert a.csv /dev/null --to csv && test -c /dev/null").exit_code, 0);
  EXPECT_EQ(Shell("lobefit convert a.csv /dev/full --to csv").exit_code, 3);
}

// A file that could not be read again is not written.
TEST_F(Outputs, ChannelsThatACsvCannotNameAreRefused) {
  for (const char* names : {"<b>R&D</b>,second", "R,G", "a b,550nm"}) {
    std::string text = std::string("VARS theta_i,phi_i,theta_s,phi_s,") + names + "\n";
    for (int i = 0; i < 40; ++i)
      text += std::to_string(10 + 20 * (i / 10)) + ",0," + std::to_string(7 * (i % 10)) + ",180,0.3,0.2\n";
    WriteWholeFile(folder_ / "odd.astm", text);
    const ProgramResult result = Shell("lobefit convert odd.astm odd.csv --angle-unit deg");
    EXPECT_EQ(result.exit_code, 3) << names << result.out;
    EXPECT_THAT(result.err, testing::HasSubstr("choose one channel with --channels, or another format")) << names;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "odd.csv")) << names;
  }
}

// Files are made in --out and nowhere else; said before the work, with nothing made.
TEST_F(Outputs, ANameIsNoPath) {
  ASSERT_EQ(Shell("cp $SOURCE/samples/satin_plastic.csv . && mkdir a").exit_code, 0);
  for (const std::string verb : {"fit satin_plastic.csv --recipe ggx", "compare satin_plastic.csv --recipes ggx"}) {
    const ProgramResult result = Shell("lobefit " + verb + " --no-report --out new --name ../a/x");
    EXPECT_EQ(result.exit_code, 2) << verb << result.err;
    EXPECT_THAT(result.err, testing::HasSubstr("is a path; the folder is given by --out")) << verb;
  }
  EXPECT_EQ(Files(), (std::vector<std::string>{"a", "satin_plastic.csv"}));
}

// Names that end a string in the language of some target.
TEST_F(Outputs, ExportsOfAnyNameAreReadBack) {
  ASSERT_EQ(Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --recipe ggx --no-report --name m").exit_code, 0);
  for (const char* name : {"R&D", "a\"b", "it's", "<x>", "back\\slash", "ü x"}) {
    const ProgramResult result = Shell(
        "lobefit export m.material.json --to pbrt,mitsuba,materialx,openpbr,gltf,osl,glsl --name " + ShellWord(name));
    EXPECT_EQ(result.exit_code, 0) << name << result.err;
  }
}

}  // namespace
}  // namespace lobefit
