// Several tables in one sheet, side by side.
#include "tests/io/csv/read_csv.h"

namespace lobefit {
namespace {

TEST(CsvSideTables, UnderHeadingsThatSayTheIncidence) {
  for (const char* head :
       {"AOI 10,,,AOI 30,,\ntheta_s,BRDF,,theta_s,BRDF,\n", "theta_i=10,,,theta_i=30,,\nangle,BRDF,,angle,BRDF,\n",
        "Sheet 1\nAOI 10 deg,,,AOI 30 deg,,\nScatter angle (deg),BRDF (1/sr),,Scatter angle (deg),BRDF (1/sr),\n"}) {
    SCOPED_TRACE(head);
    const Measurement m = ReadText(std::string(head) + "20,0.5,,25,0.25,\n30,0.4,,35,0.2,\n,,,45,0.1,\n");
    ASSERT_EQ(m.samples.size(), 5U);
    ExpectSample(m, 0, 10, 0, 20, 180, 0.5);
    ExpectSample(m, 1, 30, 0, 25, 180, 0.25);
    ExpectSample(m, 4, 30, 0, 45, 180, 0.1);
    EXPECT_EQ(m.set_aside.total(), 0U);
    EXPECT_TRUE(HasRemark(m, "2 tables stand side by side"));
  }
}

TEST(CsvSideTables, WithAnglesAndUncertaintiesOfTheirOwn) {
  const Measurement m = ReadText(
      "theta_i,theta_o,BRDF,sigma,,theta_i,theta_o,BRDF,sigma\n10,20,0.5,0.02,,30,25,0.25,0.01\n10,30,0.4,0.03,,30,35,"
      "0.2,"
      "0.04\n10,40,0.3,0.05,,,,,\n");
  ASSERT_EQ(m.samples.size(), 5U);
  ExpectSample(m, 1, 30, 0, 25, 180, 0.25);
  ASSERT_EQ(m.samples.sigma.size(), 5U);
  EXPECT_NEAR(m.samples.sigma[3], 0.04, 1e-15);
}

TEST(CsvSideTables, WithUncertaintiesWithinCells) {
  const Measurement m =
      ReadText("AOI 10;;AOI 30;\nangle;BRDF;angle;BRDF\n0;0,31 ± 0,02;0;0,24 ± 0,01\n20;0,28 ± 0,03;30;0,52 ± 0,04\n");
  ASSERT_EQ(m.samples.size(), 4U);
  ExpectSample(m, 3, 30, 0, 30, 180, 0.52);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(m.samples.sigma[i], (std::vector{0.02, 0.01, 0.03, 0.04})[i], 1e-15);
}

TEST(CsvSideTables, WhatDoesNotGoTogetherIsAsked) {
  const std::string rows = "20,0.5,25,0.25\n30,0.4,35,0.2\n";
  EXPECT_NE(MessageOf("AOI 10,,sample B,\ntheta_o,BRDF,theta_o,BRDF\n" + rows).find("under headings as in 'AOI 10'"),
            std::string::npos);
  EXPECT_NE(MessageOf("AOI 10,,AOI 0.5 rad,\ntheta_o,BRDF,theta_o,BRDF\n" + rows).find("mean the same"),
            std::string::npos);
  EXPECT_NE(MessageOf("theta_o,BRDF,theta_o,BRDF\n" + rows).find("theta_i"), std::string::npos);
}

TEST(CsvSideTables, NumbersOfAnInstrumentsHeadAreNoRow) {
  const Measurement m = ReadText(
      "Channels\t3\nSamples\t2\t2\t2\n***End_of_Header***\ntheta_i\ttheta_o\tBRDF\n10\t20\t0.5\n10\t30\t0.25\n");
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectSample(m, 1, 10, 0, 30, 180, 0.25);
}

TEST(CsvSideTables, RemarksOnColumnsAreNoNames) {
  const Measurement m = ReadText(
      "theta_i\tphi_i\ttheta_s\tphi_s\tBSDF\ndeg\tdeg\tdeg\tdeg\tsr^-1\nincidence\tincidence\tscatter\tscatter\tsample "
      "A\n10\t20\t30\t40\t0.5\n");
  ASSERT_EQ(m.samples.size(), 1U);
  ExpectSample(m, 0, 10, 20, 30, 40, 0.5);
}

}  // namespace
}  // namespace lobefit
