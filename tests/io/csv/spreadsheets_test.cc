// One table in the shapes in which spreadsheets and programs hand it over.
#include <cmath>

#include "tests/io/csv/read_csv.h"
#include <gmock/gmock.h>

namespace lobefit {
namespace {

void ExpectTheRows(const Measurement& m) {
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectSample(m, 0, 10, 20, 30, 40, 0.5);
  ExpectSample(m, 1, 50, 60, 70, 80, 0.25);
}

TEST(Spreadsheets, EveryShapeOfTheSameTable) {
  for (const char* text : {
           "Report;;;;\nSample: "
           "A1;;;;\nOperator;N.N.;;;\n;;;;\ntheta_i;phi_i;theta_o;phi_o;brdf\n10;20;30;40;0.5\n50;60;70;80;0.25\n",
           "theta_i,phi_i,theta_o,phi_o,brdf\ndeg,deg,deg,deg,1/sr\n10,20,30,40,0.5\n50,60,70,80,0.25\n",
           "theta_i,phi_i,theta_o,phi_o,brdf\n[°],[°],[°],[°],[sr^-1]\n10,20,30,40,0.5\n50,60,70,80,0.25\n",
           "sep=;\ntheta_i;phi_i;theta_o;phi_o;brdf\n10;20;30;40;0.5\n50;60;70;80;0.25\n",
           "theta_i,phi_i,theta_o,phi_o,brdf\n10,20,30,40,0.5\n,,,,\n50,60,70,80,0.25\n,,,,\n\n",
           "theta_i\tphi_i\ttheta_o\tphi_o\tbrdf\t\n10\t20\t30\t40\t0.5\t\n50\t60\t70\t80\t0.25\t\n",
           "theta_i,phi_i,theta_o,phi_o,brdf\n10,20,30,40,0.5,\n50,60,70,80,0.25,\n",
           "\"theta_i\",\"phi_i\",\"theta_o\",\"phi_o\",\"brdf\"\n\"10\",\"20\",\"30\",\"40\",\"0.5\"\n\"50\",\"60\","
           "\"70\",\"80\",\"0.25\"\n",
           ",theta_i,phi_i,theta_o,phi_o,brdf\n0,10,20,30,40,0.5\n1,50,60,70,80,0.25\n",
           "\"\",\"theta_i\",\"phi_i\",\"theta_o\",\"phi_o\",\"brdf\"\n\"1\",10,20,30,40,0.5\n\"2\",50,60,70,80,0.25\n",
           "theta_i,phi_i,theta_o,phi_o,brdf\n10,20,30,40,0.5\n50,60,70,80,0.25\nEnd of data\n",
           "theta_i,phi_i,theta_o,phi_o,brdf\n10,20,30,40,0.5\n50,60,70,80,0.25\n\nMean,,,,0.375\n",
           "Illumination,,Viewing,,\ntheta_i,phi_i,theta_o,phi_o,brdf\n10,20,30,40,0.5\n50,60,70,80,0.25\n",
           "Illumination,,Viewing,,\ntheta,phi,theta,phi,BRDF\n10,20,30,40,0.5\n50,60,70,80,0.25\n",
           "theta_i;phi_i;theta_o;phi_o;brdf\n10;20;30;40;0,5\n50;60;70;80;0,25\n",
           "theta_i\tphi_i\ttheta_o\tphi_o\tbrdf\n10,0\t20\t30\t40\t5,0E-01\n50\t60\t70\t80\t0,25\n",
           "theta_i;phi_i;theta_o;phi_o;brdf\n\"10\";\"20\";\"30\";\"40\";\"0,5\"\n\"50\";\"60\";\"70\";\"80\";\"0,"
           "25\"\n",
           "theta_i|phi_i|theta_o|phi_o|brdf\n10|20|30|40|0.5\n50|60|70|80|0.25\n",
           "theta_i,phi_i,theta_o,phi_o,comment,brdf\n10,20,30,40,\"dull, grey\",0.5\n50,60,70,80,\"a "
           "\"\"b\"\"\",0.25\n",
           "\"theta_i\n(deg)\",\"phi_i\n(deg)\",theta_o,phi_o,brdf\n10,20,30,40,0.5\n50,60,70,80,0.25\n",
           "theta_i,phi_i,theta_o,phi_o,brdf\r\n10,20,30,40,0.5\r\n50,60,70,80,0.25",
           "theta_i,phi_i,theta_o,phi_o,brdf\r\r\n10,20,30,40,0.5\r\r\n50,60,70,80,0.25\r\r\n",
           "theta_i,phi_i,theta_o,phi_o,brdf\r10,20,30,40,0.5\r50,60,70,80,0.25\r",
           "\xef\xbb\xbf# a comment\ntheta_i,phi_i,theta_o,phi_o,brdf\n10,20,30,40,0.5\n50,60,70,80,0.25\n",
           "theta_i,phi_i,theta_o,phi_o,brdf\n10,20,30,40,0.5\ntheta_i,phi_i,theta_o,phi_o,brdf\n50,60,70,80,0.25\n",
           "theta_i phi_i theta_o phi_o brdf\n10 20 30 40 0.5\n50 60 70 80 0.25\n",
           "# theta_i phi_i theta_o phi_o brdf\n# deg deg deg deg 1/sr\n10 20 30 40 0.5\n50 60 70 80 0.25\n",
           "theta_i;phi_i;theta_o;phi_o;brdf\n\xc2\xa0"
           "10;20;30;40;0.5\n\xc2\xa0"
           "50;60;70;80;0.25\n",
           "Messung vom 1.1.\nProbe A1\n\ntheta_i phi_i theta_o phi_o brdf\n10 20 30 40 0.5\n50 60 70 80 0.25\n",
       }) {
    SCOPED_TRACE(text);
    ExpectTheRows(ReadText(text));
  }
}

TEST(Spreadsheets, Utf16WithAndWithoutItsMark) {
  const std::string text = "theta_i,phi_i,theta_o,phi_o,brdf\n10,20,30,40,0.5\n50,60,70,80,0.25\n";
  for (const bool big : {false, true}) {
    for (const bool mark : {false, true}) {
      std::string wide = !mark ? "" : big ? "\xfe\xff" : "\xff\xfe";
      for (const char c : text) {
        if (big) wide += '\0';
        wide += c;
        if (!big) wide += '\0';
      }
      const Measurement m = ReadText(wide);
      ExpectTheRows(m);
      EXPECT_TRUE(HasRemark(m, "UTF-16"));
    }
  }
}

TEST(Spreadsheets, Utf16OfAnyLetters) {
  // 入射角, 反射角, f
  const Measurement m = ReadText(
      std::string("\xff\xfe\x65\x51\x04\x5c\xd2\x89,\0\xcd\x53\x04\x5c\xd2\x89,\0f\0\n\0", 22) + std::string("1\0"
                                                                                                             "0\0,\0"
                                                                                                             "2\0"
                                                                                                             "0\0,\0"
                                                                                                             "1\0\n\0",
                                                                                                             16));
  ASSERT_EQ(m.samples.size(), 1U);
  ExpectSample(m, 0, 10, 0, 20, 180, 1);
}

TEST(Spreadsheets, UnitsOfACommentBelowTheNames) {
  const Measurement m = ReadText("# theta_i theta_o brdf\n# rad rad 1/sr\n0.5 0.25 1\n0.5 0.75 2\n");
  EXPECT_NEAR(std::acos(m.samples.wo_z[1]), 0.75, 1e-12);
}

TEST(Spreadsheets, UnitsOfARowBelowTheNames) {
  const Measurement m = ReadText(
      "wavelength,theta_i,theta_o,reflectance factor\num,rad,rad,%\n0.55,0.5235987755982988,0.7853981633974483,50\n");
  ExpectSample(m, 0, 30, 0, 45, 180, 0.5 / kPi);
  EXPECT_EQ(m.channels.wavelengths_nm, (std::vector<double>{550}));
}

TEST(Spreadsheets, WhatIsRefusedSaysWhy) {
  EXPECT_NE(MessageOf("theta_i;theta_o;f\n10;20;1.234,5\n").find("separators between thousands"), std::string::npos);
  EXPECT_NE(MessageOf("theta_i;theta_o;f\n10.5;20;0,5\n").find("some a decimal point"), std::string::npos);
  // Words amid the rows are no footer.
  EXPECT_NE(MessageOf("theta_i,theta_o,f\n10,20,1\nfirst part ended\n10,30,1\n").find("line 3"), std::string::npos);
  // A lone quote does not swallow the rest.
  EXPECT_NE(MessageOf("theta_i,theta_o,f\n10,20,\"1\n10,30,1\n").find("line 2"), std::string::npos);
}

TEST(Spreadsheets, TheFooterIsSaid) {
  const Measurement m = ReadText("theta_i,theta_o,f\n10,20,1\nEnd of data\nsigned, N.N.\n");
  EXPECT_TRUE(HasRemark(m, "2 lines after the last row, from line 3 on, hold no row: 'End of data'"));
}

TEST(Spreadsheets, DecimalCommasInQuotesBetweenCommas) {
  const Measurement m = ReadText("theta_i,theta_o,dphi,brdf\n10,20,0,\"0,5\"\n10,\"20,5\",0,\"1,25\"\n");
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectSample(m, 0, 10, 0, 20, 0, 0.5);
  ExpectSample(m, 1, 10, 0, 20.5, 0, 1.25);
}

TEST(Spreadsheets, NumbersAsFortranAndPeopleWriteThem) {
  const Measurement m = ReadText("theta_i theta_o dphi brdf\n10° 20° 0 0.5D-01\n10 25 0 5.0d+00\n");
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectSample(m, 0, 10, 0, 20, 0, 0.05);
  ExpectSample(m, 1, 10, 0, 25, 0, 5);
  ExpectSample(ReadText("theta_i,theta_o,dphi,brdf\n10,20,0,5%\n10,25,0,6%\n"), 0, 10, 0, 20, 0, 0.05);
  EXPECT_NE(MessageOf("theta_i,theta_o,brdf\n10°75',20°00',5\n").find("'10°75'', which is not a number"),
            std::string::npos);
}

TEST(Spreadsheets, TheNamesAgainInAnotherSpelling) {
  EXPECT_EQ(ReadText("theta_i,theta_o,dphi,brdf\n10,20,0,1\nTheta_I, Theta_O, dPhi, BRDF\n30,20,0,1\n").samples.size(),
            2U);
  EXPECT_NE(MessageOf("theta_i,theta_o,dphi,brdf\n10,20,0,1\ntheta_o,theta_i,dphi,brdf\n30,20,0,1\n")
                .find("line 3: names other columns than line 1, or in another order or unit"),
            std::string::npos);
}

TEST(Spreadsheets, SummariesBelowTheRows) {
  const Measurement m = ReadText("theta_i,theta_o,dphi,brdf\n10,20,0,1\n10,30,0,2\nAverage,25,0,1.5\n");
  EXPECT_EQ(m.samples.size(), 2U);
  EXPECT_TRUE(HasRemark(m, "1 line after the last row, from line 4 on"));
}

TEST(Spreadsheets, ATitleOfNumbersIsNoRow) {
  EXPECT_EQ(ReadText("My lab\nDate: 1,2,3,4\n\ntheta_i,theta_o,dphi,brdf\n10,20,0,1\n").samples.size(), 1U);
}

TEST(Spreadsheets, AHeadingOverAnEmptyCell) {
  const Measurement m = ReadText("Incidence,,Scatter,,BRDF\ntheta,phi,theta,phi,\n10,20,30,40,5\n");
  ASSERT_EQ(m.samples.size(), 1U);
  ExpectSample(m, 0, 10, 20, 30, 40, 5);
}

TEST(Spreadsheets, RowNumbersOfRWithoutAName) {
  const Measurement m = ReadText("\"theta_i\" \"theta_o\" \"dphi\" \"brdf\"\n\"1\" 10 20 0 5\n\"2\" 10 30 0 6\n");
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectSample(m, 1, 10, 0, 30, 0, 6);
  EXPECT_TRUE(HasRemark(m, "it counts the rows"));
  // Not where the numbers do not count.
  EXPECT_NE(MessageOf("theta_i theta_o dphi brdf\n1 10 20 0 5\n3 10 30 0 6\n").find("has 5 fields"), std::string::npos);
}

TEST(Spreadsheets, RowsWithoutNamesByTheirNumbers) {
  ReadOptions options;
  options.columns = "theta_i=#1,theta_o=#2,dphi=#3,f=#4";
  const Measurement m = ReadText("10,20,0,5\n10,30,90,6\n", options);
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectSample(m, 1, 10, 0, 30, 90, 6);
}

TEST(Spreadsheets, ATitleWithItsValueIsNoHeading) {
  for (const char* head : {"Scatter Table\nIncident Angle\t30\nPolar\tAzimuth\tBSDF\n0\t0\t1\n20\t180\t2\n",
                           "AOI = 30\nWavelength 0.633\nTheta Phi BRDF\n0 0 1\n20 180 2\n"}) {
    const Measurement m = ReadText(head);
    ASSERT_EQ(m.samples.size(), 2U) << head;
    ExpectSample(m, 1, 30, 0, 20, 180, 2);
  }
}

TEST(Spreadsheets, StandardUncertaintyBesideAnExpandedOne) {
  const Measurement m = ReadText("theta_i,theta_o,BRDF,u_BRDF,U_BRDF\n10,20,2,0.1,0.2\n10,30,4,0.1,0.2\n");
  ASSERT_EQ(m.samples.sigma.size(), 2U);
  EXPECT_NEAR(m.samples.sigma[0], 0.1, 1e-12);
  // Alone, an expanded one of unknown factor is asked about.
  EXPECT_NE(MessageOf("theta_i,theta_o,BRDF,U_BRDF\n10,20,2,0.2\n").find("whose factor k is not said"),
            std::string::npos);
}

TEST(Spreadsheets, JsonOfAnotherKindIsSaid) {
  EXPECT_NE(MessageOf("[{\"theta_i\": 10, \"theta_o\": 20, \"brdf\": 1}]").find("is JSON of a kind that is not known"),
            std::string::npos);
}

// Names divided in another way than the rows below them.
TEST(Spreadsheets, NamesBetweenOtherMarksThanTheNumbers) {
  for (const char* text :
       {"theta_i,phi_i,theta_o,phi_o,brdf\n10;20;30;40;0,5\n50;60;70;80;0,25\n",
        "theta_i\tphi_i\ttheta_o\tphi_o\tbrdf\n10 20 30 40 0.5\n50 60 70 80 0.25\n",
        "theta_i (deg)  phi_i (deg)  theta_o (deg)  phi_o (deg)  BRDF (1/sr)\n10 20 30 40 0.5\n50 60 70 80 0.25\n",
        "theta_i (deg) phi_i (deg) theta_o (deg) phi_o (deg) BRDF (1/sr)\n10 20 30 40 0.5\n50 60 70 80 0.25\n",
        "Incident angle  Incident azimuth  Scatter angle  Scatter azimuth  BRDF\n10 20 30 40 0.5\n50 60 70 80 0.25\n",
        "theta_i phi_i theta_o phi_o brdf\n10,0 20,0 30,0 40,0 0,5\n50,0 60,0 70,0 80,0 0,25\n"}) {
    SCOPED_TRACE(text);
    ExpectTheRows(ReadText(text));
  }
  // Blanks behind commas do not make the commas decimal ones.
  EXPECT_NE(MessageOf("theta_i, theta_o, brdf\n10,0, 20,0, 0,5\n").find("has 6 fields"), std::string::npos);
  ExpectTheRows(ReadText("theta_i, phi_i, theta_o, phi_o, brdf\n10, 20, 30, 40, 0.5\n50, 60, 70, 80, 0.25\n"));
}

TEST(Spreadsheets, UnitsAboveTheNamesAndUnitsThatAreNotKnown) {
  const Measurement m = ReadText("rad;rad;1/sr\ntheta_i;theta_o;f\n0.5235987755982988;0.7853981633974483;2\n");
  ExpectSample(m, 0, 30, 0, 45, 180, 2);
  EXPECT_NE(MessageOf("theta_i;theta_o;f\nturns;turns;1/sr\n0.1;0.2;2\n").find("'theta_i', has the unit 'turns'"),
            std::string::npos);
  EXPECT_NE(MessageOf("theta_i;theta_o;f;u\ndeg;deg;1/sr;furlong\n1;2;2;1\n").find("'u', has the unit 'furlong'"),
            std::string::npos);
  const Measurement expanded = ReadText("theta_i;theta_o;f;U\ndeg;deg;1/sr;k=2\n10;20;2;0.2\n");
  EXPECT_NEAR(expanded.samples.sigma[0], 0.1, 1e-12);
}

TEST(Spreadsheets, CommentsInQuotes) {
  const Measurement m = ReadText("\"# Lab 3, room 2\";;\n\"# AOI: 30 deg\";;\ntheta_o;f;n\n45;2;1\n");
  ExpectSample(m, 0, 30, 0, 45, 180, 2);
  // A nameless mark for the row's number is no comment.
  EXPECT_EQ(ReadText("\"#\",\"theta_i\",\"theta_o\",\"f\"\n1,30,45,2\n").samples.size(), 1U);
}

TEST(Spreadsheets, HeadsOfPagesAmidTheRows) {
  const Measurement m =
      ReadText("Page 1\ntheta_i,theta_o,f\n10,20,1\nPage 2\n-----\ntheta_i,theta_o,f\n10,30,2\nEnd\n");
  ASSERT_EQ(m.samples.size(), 2U);
  EXPECT_TRUE(HasRemark(m, "1 line after the last row, from line 8 on"));
  EXPECT_NE(MessageOf("theta_i,theta_o,f\n10,20,1\nPage 2\n10,30,2\n").find("line 3: column 1 (theta_i) is 'Page 2'"),
            std::string::npos);
}

TEST(Spreadsheets, SignsOfTypesettersAndOtherThousands) {
  const Measurement m = ReadText(
      "theta_i,theta_o,f\n30,\xe2\x88\x92"
      "45,1\n30,20,\xe2\x88\x92"
      "0.5\n");
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectSample(m, 0, 30, 0, 45, 0, 1);
  EXPECT_EQ(m.samples.values[0][1], -0.5);
  for (const char* number : {"1'234.5",
                             "1\xc2\xa0"
                             "234,5",
                             "1\xe2\x80\xaf"
                             "234,5"}) {
    EXPECT_NE(MessageOf("theta_i;theta_o;f\n10;20;" + std::string(number) + "\n").find("separators between thousands"),
              std::string::npos)
        << number;
  }
  EXPECT_NE(MessageOf("theta_i,theta_o,f\n10,20,1\n10,30,~\n").find("use --no-value \"~\""), std::string::npos);
}

// Long names, units and remarks below each other, as Origin writes them; a "Scatter" in degrees is an angle.
TEST(Spreadsheets, NamesUnitsAndRemarksBelowEachOther) {
  for (const char* text :
       {"Incidence\tScatter\tBRDF\ndeg\tdeg\t1/sr\n\t\tsample A\n10\t20\t0.5\n30\t40\t0.25\n",
        "Long Name\tIncidence\tScatter\tBRDF\nUnits\tdeg\tdeg\t1/sr\nComments\t\t\tA\n\t10\t20\t0.5\n"
        "\t30\t40\t0.25\n",
        "Incidence,Detector,BRDF\n[deg],[deg],[1/sr]\n10,20,0.5\n30,40,0.25\n",
        "Incidence,Scatter,BRDF\nangle (deg),angle (deg),(1/sr)\n10,20,0.5\n30,40,0.25\n"}) {
    const Measurement m = ReadText(text);
    ASSERT_EQ(m.samples.size(), 2U) << text;
    ExpectSample(m, 1, 30, 0, 40, 180, 0.25);
  }
  EXPECT_NE(MessageOf("Incidence,Scatter,BRDF\n10,20,0.5\n").find("theta_o"), std::string::npos) << "not said";
}

TEST(Spreadsheets, ABlockBeginsWithItsNamesAndUnits) {
  const std::string names = "Scatter angle;BRDF\ndeg;1/sr\n";
  const Measurement m =
      ReadText("Incidence angle;10;deg\n" + names + "20;0,5\n;\nIncidence angle;30;deg\n" + names + "40;0,25\n");
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectSample(m, 0, 10, 0, 20, 180, 0.5);
  ExpectSample(m, 1, 30, 0, 40, 180, 0.25);
  EXPECT_NE(MessageOf("Incidence angle;10;deg\n" + names +
                      "20;0,5\nIncidence angle;30;deg\nScatter angle;BRDF\nrad;1/sr\n"
                      "0,7;0,25\n")
                .find("'rad', which is not a number"),
            std::string::npos);
}

TEST(Spreadsheets, MarksAroundTheText) {
  const std::string rows = "theta_i,phi_i,theta_o,phi_o,brdf\n10,20,30,40,0.5\n50,60,70,80,0.25\n";
  for (const std::string& text : {rows + "\x1a", rows + std::string(300, '\0'), "\ufeff\ufeff" + rows,
                                  rows.substr(0, 49) + "\ufeff" + rows.substr(0, 33) + rows.substr(49)}) {
    const Measurement m = ReadText(text);
    ExpectTheRows(m);
    EXPECT_TRUE(m.remarks.empty());
  }
  const Measurement m = ReadText(
      "theta_i\u00a0;\u00a0phi_i;theta_o;phi_o;brdf\n10\u00a0;\u00a020;30;40;\u00a00,5\n50;60;70;80;\u00a00,25\n");
  ExpectTheRows(m);
}

TEST(Spreadsheets, ALineOfNumbersAboveTheNames) {
  const std::string rows = "theta_i,phi_i,theta_o,phi_o,brdf\n10,20,30,40,0.5\n50,60,70,80,0.25\n";
  ExpectTheRows(ReadText("Min,Max,Mean\n0.25,0.5,0.375\n\n" + rows));
  // More of them are rows whose names are missing.
  EXPECT_NE(MessageOf("1,2,3\n4,5,6\n7,8,9\n" + rows).find("no line names the columns"), std::string::npos);
}

TEST(Spreadsheets, NumbersWrittenForPeople) {
  for (const char* row : {"=\"30\",=\"40\",=\"0.25\"", "'30,'40,'0.25", "30,40,2.5x10^-1",
                          "30,40,2.5\u00b710\u207b\u00b9", "30,40,2.5 \u00d7 10^-1"}) {
    const Measurement m = ReadText("theta_i,theta_o,brdf\n10,20,0.5\n" + std::string(row) + "\n");
    ASSERT_EQ(m.samples.size(), 2U) << row;
    ExpectSample(m, 1, 30, 0, 40, 180, 0.25);
  }
}

// "1,234" is one thousand to some and a little more than one to others.
TEST(CsvSpreadsheets, CommasBetweenThousands) {
  EXPECT_NE(MessageOf("theta_i,theta_o,brdf\n10,20,\"1,234\"\n10,30,999\n").find("one between thousands"),
            std::string::npos);
  EXPECT_NEAR(ReadText("theta_i,theta_o,brdf\n10,20,\"1,234\"\n10,30,\"0,999\"\n").samples.values[0][0], 1.234, 1e-12);
  EXPECT_NEAR(ReadText("theta_i;theta_o;brdf\n10;20;1,234\n10;30;2,345\n").samples.values[0][0], 1.234, 1e-12);
}

TEST(CsvSpreadsheets, EncodingsOfOtherScripts) {
  const std::string rows = ",brdf\n30,40,1\n";
  // "incident angle, reflected angle" in GB18030, Shift-JIS, EUC-KR, Windows-1251 and Windows-1250.
  for (const auto& [name, head] : {std::pair{"GB18030", "\xc8\xeb\xc9\xe4\xbd\xc7,\xb7\xb4\xc9\xe4\xbd\xc7"},
                                   {"SHIFT_JIS", "\x93\xfc\x8e\xcb\x8a\x70,\x94\xbd\x8e\xcb\x8a\x70"},
                                   {"EUC-KR", "\xc0\xd4\xbb\xe7\xb0\xa2,\xb9\xdd\xbb\xe7\xb0\xa2"},
                                   {"WINDOWS-1250", "k\xb9t padania,k\xb9t odbicia"},
                                   {"WINDOWS-1251",
                                    "\xf3\xe3\xee\xeb \xef\xe0\xe4\xe5\xed\xe8\xff,"
                                    "\xf3\xe3\xee\xeb \xee\xf2\xf0\xe0\xe6\xe5\xed\xe8\xff"}}) {
    const Measurement m = ReadText(head + rows);
    ExpectSample(m, 0, 30, 0, 40, 180, 1);
    EXPECT_TRUE(HasRemark(m, name)) << name;
  }
  // A byte that is left out of a number makes another number.
  EXPECT_THAT(MessageOf("\xc8\xeb\xc9\xe4\xbd\xc7,\xb7\xb4\xc9\xe4\xbd\xc7,brdf\n30,40,0.1\xff 5\n"),
              testing::HasSubstr("byte 28: is neither UTF-8 nor GB18030 text"));
}

}  // namespace
}  // namespace lobefit
