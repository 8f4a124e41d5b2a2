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

TEST_F(ReportVerb, RefusesOneSample) {
  FitOne();
  WriteWholeFile(folder_ / "one.csv", "theta_i,phi_i,theta_o,phi_o,R,G,B\n10,0,20,180,0.5,0.4,0.3\n");
  const ProgramResult result = Shell("lobefit report fitted.material.json one.csv --out one.png");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("one.csv: only one sample within the angle limit"));
  EXPECT_THAT(Files(), testing::ElementsAre("fitted.material.json", "one.csv"));
}

// Two samples of one plane: figures that need more are left out. Maps cannot be drawn, and that is said.
TEST_F(ReportVerb, DrawsTwoSamplesButNoMaps) {
  FitOne();
  WriteWholeFile(folder_ / "two.csv",
                 "theta_i,phi_i,theta_o,phi_o,R,G,B\n10,0,20,180,0.5,0.4,0.3\n10,0,25,180,0.5,0.4,0.3\n");
  EXPECT_EQ(Shell("lobefit report fitted.material.json two.csv --format png,html --out two.png").exit_code, 0);
  EXPECT_THAT(Files(), testing::IsSupersetOf({"two.png", "two.html"}));
  // The name says the format.
  EXPECT_EQ(Shell("lobefit report fitted.material.json two.csv --out alone.html").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "alone.html"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "alone.png"));
  const ProgramResult maps = Shell("lobefit report fitted.material.json two.csv --format exr --out two.png");
  EXPECT_EQ(maps.exit_code, 3);
  EXPECT_THAT(maps.err, HasSubstr("fills no map"));
}

TEST_F(ReportVerb, OutIsAPictureOrAFolder) {
  FitOne();
  WriteWholeFile(folder_ / "notes", "of the user");
  const std::string report = "lobefit report fitted.material.json $SOURCE/samples/satin_plastic.csv --scale 0.5 --out ";
  EXPECT_EQ(Shell(report + "notes").exit_code, 2);
  EXPECT_EQ(ReadWholeFile(folder_ / "notes"), "of the user");
  const ProgramResult folder = Shell("mkdir pictures && " + report + "pictures");
  EXPECT_EQ(folder.exit_code, 0) << folder.err;
  EXPECT_THAT(folder.out, HasSubstr("Picture: pictures/fitted.report.png"));
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
TEST_F(ReportVerb, NothingIsBegunWhereThePictureCannotBeWritten) {
  const ProgramResult result =
      Shell("mkdir -p x.report.png/taken && lobefit fit $SOURCE/samples/satin_plastic.csv --name x");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("x.report.png"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x.material.json"));
}

TEST_F(ReportVerb, PictureOfTheCoverage) {
  const ProgramResult result = Shell("lobefit info $SOURCE/samples/brushed_metal.csv --png cover.png");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("Picture: cover.png"));
  EXPECT_EQ(ReadWholeFile(folder_ / "cover.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
}

}  // namespace
}  // namespace lobefit
