// Reports on the command line: formats, and what is refused with exit 3 and a reason.
#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

using testing::HasSubstr;

class ReportVerb : public ProgramTest {
 protected:
  // fitted.material.json, of the channels R, G, B.
  void FitOne() {
    ASSERT_EQ(Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --no-report --name fitted").exit_code, 0);
  }
};

TEST_F(ReportVerb, WritesEveryFormat) {
  const ProgramResult result = Shell("lobefit fit $SOURCE/samples/brushed_metal.csv --format exr,png,html --name all");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(Files(),
              testing::ElementsAre("all.material.json", "all.report.exr", "all.report.html", "all.report.png"));
  EXPECT_EQ(ReadWholeFile(folder_ / "all.report.exr").substr(0, 4), "\x76\x2f\x31\x01");
  for (const char* line : {"Maps:    ./all.report.exr", "Picture: ./all.report.png", "Page:    ./all.report.html"})
    EXPECT_THAT(result.out, HasSubstr(line));
  const ProgramResult unknown =
      Shell("lobefit report all.material.json $SOURCE/samples/brushed_metal.csv --format jpg");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("allowed: png, html, exr"));
}

TEST_F(ReportVerb, RefusesOtherChannels) {
  FitOne();
  WriteWholeFile(folder_ / "mono.csv", "theta_i,phi_i,theta_o,phi_o,f\n10,0,20,180,1\n10,0,30,180,1\n");
  const ProgramResult result = Shell("lobefit report fitted.material.json mono.csv");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("mono.csv: the measurement has the channels Y, the material has R, G, B"));
  EXPECT_THAT(Files(), testing::ElementsAre("fitted.material.json", "mono.csv"));
}

TEST_F(ReportVerb, RefusesOtherWavelengths) {
  WriteWholeFile(folder_ / "a.csv",
                 "theta_i,phi_i,theta_o,phi_o,450nm,550nm\n10,0,20,180,1,2\n10,0,30,180,1,2\n20,0,30,180,1,3\n");
  WriteWholeFile(folder_ / "b.csv", "theta_i,phi_i,theta_o,phi_o,450nm,650nm\n10,0,20,180,1,2\n");
  Shell("lobefit fit a.csv --recipe ggx --channels all --no-report --name a");
  ASSERT_THAT(Files(), testing::Contains("a.material.json"));
  const ProgramResult result = Shell("lobefit report a.material.json b.csv --channels all");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("channels 450nm, 650nm, the material has 450nm, 550nm"));
}

// A single sample can be drawn: figures that need more are left out. Maps cannot, and that is said.
TEST_F(ReportVerb, OneSample) {
  FitOne();
  WriteWholeFile(folder_ / "one.csv", "theta_i,phi_i,theta_o,phi_o,R,G,B\n10,0,20,180,0.5,0.4,0.3\n");
  const ProgramResult result = Shell("lobefit report fitted.material.json one.csv --format png,html --out one.png");
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 3) << result.err;
  const ProgramResult maps = Shell("lobefit report fitted.material.json one.csv --format exr --out one.png");
  EXPECT_EQ(maps.exit_code, 3);
  EXPECT_THAT(maps.err, HasSubstr("fills no map"));
}

TEST_F(ReportVerb, AFolderThatCannotBeWritten) {
  FitOne();
  WriteWholeFile(folder_ / "file", "not a folder");
  const ProgramResult result =
      Shell("lobefit report fitted.material.json $SOURCE/samples/satin_plastic.csv --out file/x.png");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("file/x.png"));
}

// What was fitted is kept where drawing fails: here the picture's name is taken by a folder.
TEST_F(ReportVerb, TheDocumentIsKeptWhereDrawingFails) {
  const ProgramResult result =
      Shell("mkdir -p x.report.png/taken && lobefit fit $SOURCE/samples/satin_plastic.csv --name x");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("x.report.png"));
  EXPECT_THAT(ReadWholeFile(folder_ / "x.material.json"), HasSubstr("\"parameters\""));
}

TEST_F(ReportVerb, PictureOfTheCoverage) {
  const ProgramResult result = Shell("lobefit info $SOURCE/samples/brushed_metal.csv --png cover.png");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("Picture: cover.png"));
  EXPECT_EQ(ReadWholeFile(folder_ / "cover.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
}

}  // namespace
}  // namespace lobefit
